// Weights and gains of the whole-body controller, and how they follow a robot's size.
#pragma once

#include "sim/robot/robot.h"

namespace stagger::sim {

/// The defaults are for 30 kg with the CoM at 1 m. First chosen by the push scores of a biped of
/// that size on the same controller; `stagger limits` measures them. Stiffness in
/// 1/s^2, damping in 1/s.
struct WholeBodyGains {
  double com_weight = 1000.0;  ///< horizontal CoM acceleration w^2 (c - p - hip's shift)
  /// Above that of a leaning torso, whose task else lifts the body until its knees are straight.
  double height_weight = 1000.0;
  double height_stiffness = 100.0;
  double height_damping = 20.0;
  double momentum_weight = 0.01;  ///< rate of angular momentum that the hip strategy asks for
  /// Low: the hips may lean to help the balance. Below 0.8, h1_2 leans over after long steps back.
  double torso_weight = 0.85;
  double torso_stiffness = 300.0;
  double torso_damping = 35.0;
  double swing_weight = 30.0;
  double swing_stiffness = 1500.0;
  double swing_damping = 75.0;
  double swing_acceleration_limit = 100.0;  ///< [m/s^2]
  /// Of the orientation of a swing foot, which weighs next to nothing: a toe that catches at an
  /// edge of the ground would turn it over, and be dragged along.
  double swing_turn_stiffness = 30625.0;
  double swing_turn_damping = 350.0;
  /// So that a foot that was turned by a push does not outweigh the balance [rad/s^2].
  double swing_turn_acceleration_limit = 250.0;
  double stance_weight = 1e4;
  double stance_damping = 60.0;
  double angular_length = 1.0;  ///< what an angle of a foot counts as against a length [m]
  double acceleration_regularisation = 1e-2;
  double force_regularisation = 1e-6;
  double friction = 0.5;  ///< of each axis of the pyramid; its corner (0.71) is below the plant's
  double sole_margin = 0.005;       ///< corners lie this far inside the sole [m]
  double least_normal_force = 0.5;  ///< per corner [N]
  double limit_weight = 100.0;      ///< braking of a joint before the end of its range
  double ankle_limit_weight = 1.0;  ///< the same of ankles: a foot may tilt, a knee not give way
  double limit_braking = 200.0;     ///< by this it can be stopped there [rad/s^2]
  double limit_damping = 100.0;     ///< for a joint that is faster than that [1/s]
  double limit_return = 400.0;      ///< for a joint beyond its margin [1/s^2]
  double limit_margin = 0.05;       ///< before the end of the range [rad]
  /// The CoM sinks rather than let a leg be longer than this share of its length. A knee whips
  /// straight at the end of a long step, and while it is braked the foot flies on: h1_2, pushed
  /// forward by 0.694 m/s early in a step of a walk at 0.3 m/s, falls in no trial of 16, in 1 with
  /// 0.93 and in 14 with 0.97. With 0.91 g1 falls more when it is pushed backwards.
  double leg_stretch = 0.92;
  double fallback_damping = 5.0;  ///< joint torque per velocity when a solve has failed [N m s]
};

/// The defaults carried over to this robot (dynamic_scale.h), so that a robot of another size does
/// the same, only at its own size and pace: stiffnesses and dampings with its natural frequency,
/// forces with its weight. Weights of linear accelerations stay, since accelerations do not scale;
/// those of angular ones, and of joints, follow the square of a length. The orientation of a swing
/// foot is held as stiffly as `loop_delay` allows: from a measurement to the end of the tick that
/// has its torque [s].
WholeBodyGains whole_body_gains(const Robot& robot, double loop_delay = 0.002);

}  // namespace stagger::sim
