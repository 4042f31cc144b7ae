// Every number that the engine can be built with, with unit, default and allowed range.
#pragma once

#include <stdexcept>
#include <string>

#include "engine/types.h"

namespace stagger::engine {

/// Which ways of keeping balance are allowed to act.
struct Strategies {
  bool ankle = true;  ///< LQG moves the ZMP inside the support polygon
  bool hip = true;    ///< angular momentum about the CoM; needs HipParameters with a torque
  bool step = true;   ///< the place of the next step is adjusted
  bool time = true;   ///< the time of the next step is adjusted
  bool operator==(const Strategies&) const = default;
};

/// Velocity to walk with, in the frame of the robot's heading.
struct WalkCommand {
  double vx = 0.0;  ///< forward [m/s]
  double vy = 0.0;  ///< to the left [m/s]
  double wz = 0.0;  ///< turn to the left [rad/s]
};

/// Flywheel that stands for the upper body. No torque: no hip strategy.
struct HipParameters {
  double torque = 0.0;   ///< greatest torque [N m]
  double inertia = 1.0;  ///< [kg m^2]
  double angle = 0.5;    ///< greatest lean [rad]
  double rate = 1e9;     ///< greatest angular velocity [rad/s]
  bool in_steps = true;  ///< also when steps are adjusted; else only with that strategy off
};

/// Defaults are the recommended set for the paper's robot on the LIPM (30 kg, CoM at 1 m).
struct Parameters {
  double tick = 0.002;      ///< control period [s]
  double gravity = 9.81;    ///< [m/s^2]
  double com_height = 1.0;  ///< z_c [m]
  double mass = 30.0;       ///< [kg]

  double t_ss = 0.8;           ///< single support duration [s]
  double t_ds = 0.2;           ///< double support duration, 0 allowed [s]
  double t_init = 1.0;         ///< Initialize: weight shift before the first step [s]
  double stance_width = 0.2;   ///< lateral distance of the feet [m]
  double swing_height = 0.04;  ///< z_s [m]

  double foot_half_length = 0.075;  ///< [m]
  double foot_half_width = 0.0375;  ///< [m]
  double sole_margin = 0.0;  ///< kept free inside the sole's edge when the ZMP is clamped [m]
  /// An ankle of little torque moves the ZMP no farther than this from the sole's centre, along the
  /// sole's length and its width [m].
  Vec2 ankle_reach{1e9, 1e9};

  double max_step_length = 0.95;  ///< greatest x of a step in the stance foot's frame [m]
  double max_step_back = 0.95;    ///< greatest -x of a step in the stance foot's frame [m]
  double min_step_width = 0.10;   ///< least lateral distance of the feet [m]
  double max_step_width = 0.60;   ///< greatest lateral distance of the feet [m]
  double max_step_turn = 0.6;     ///< |yaw| of a step in the stance foot's frame [rad]
  double foot_clearance = 0.01;   ///< least gap between the two soles [m]
  /// Lets min_step_width be less than what keeps the soles apart side by side, and negative: the
  /// foot may then land straight before or behind the stance foot, or so far on its other side. The
  /// soles still never overlap. For adjusted steps and step lists; a commanded velocity does not
  /// cross the feet. Nothing here keeps the legs from touching on the swing foot's way across.
  bool allow_crossing = false;

  // LQG weights, scaled by the control period: diag(CoM error, DCM error, integral of CoM error),
  // ZMP. A weight of 0 for the integral: no integrator.
  Vec3 lqr_state_weight{1.0, 100.0, 1.0};
  double lqr_zmp_weight = 10.0;
  double process_noise = 1e-6;         ///< variance of [c, dcm] a tick [m^2]
  double measurement_noise = 6.25e-4;  ///< variance of the measured c and dcm [m^2]
  double push_gate = 5.0;  ///< innovations beyond this many standard deviations are a push

  /// Share of the sole by which the ankle is reckoned to move the ZMP before a step is adjusted, in
  /// [0, 1]. With 0 the ankle is not reckoned with at all, as in the paper; else all of the sole is
  /// where no step reaches.
  double ankle_share = 0.3;
  double step_gain = 1.0;     ///< k_sa of eq. (11)
  double step_margin = 0.03;  ///< compliance margin on |Delta_f| [m]
  double step_freeze = 0.06;  ///< place and time stay as they are in the last part of the swing [s]
  /// But a step whose foothold is then still farther than this from catching the DCM is taken anew,
  /// with all the time that the foot needs to get there [m].
  double step_anew = 1e9;
  double time_limit = 0.2;      ///< |adjusted - nominal| single support duration [s]
  double time_constant = 0.04;  ///< of the lag filter of eq. (13): k_f = tick / time_constant [s]
  /// A step that would have to be longer than this share of what the leg reaches, forward or
  /// backward, comes sooner as well, in (0, 1]. With 1 it does once the place has done all it can.
  double time_reach = 1.0;
  double least_t_ss = 0.15;         ///< no single support is adjusted to less [s]
  double swing_speed = 1e9;         ///< greatest speed of the swing foot [m/s]
  double swing_acceleration = 1e9;  ///< greatest acceleration of the swing foot [m/s^2]

  double contact_load = 20.0;      ///< a swing foot that carries more has landed [N]
  double landing_patience = 0.10;  ///< how long single support waits for a late landing [s]
  /// Of a foot that is late, down to where the ground is [m/s]. The DCM runs away meanwhile: at 0.1
  /// steps that came down a centimetre deeper, off a tile, threw h1_2 to the side.
  double landing_speed = 0.2;
  double landing_acceleration = 4.0;  ///< by which that foot then goes faster [m/s^2]
  double landing_rate = 60.0;  ///< of its way over the ground, to where the DCM has gone [1/s]
  /// A swing foot that carries more in the first half of its way, once it has been free, has caught
  /// at something, and waits for it to let go. Sideways on tiles of 16.4 mm h1_2 falls in 1 of 48
  /// walks of a minute; with 10 in 4 of 48, with 2.7 in 3 of 12 [N].
  double hold_load = 5.0;

  HipParameters hip;
  Strategies strategies;
};

/// One parameter that is not as it should be.
class ParameterError : public std::invalid_argument {
 public:
  ParameterError(std::string name, double value, std::string allowed);
  const std::string& name() const { return name_; }
  double value() const { return value_; }
  const std::string& allowed() const { return allowed_; }

 private:
  std::string name_;
  double value_;
  std::string allowed_;
};

/// Throws ParameterError at the first value that is not finite, out of its range, or does not go
/// with another; else returns what it was given.
const Parameters& validate(const Parameters& parameters);

/// Whether the hip strategy may act.
inline bool hip_acts(const Parameters& p) {
  return p.strategies.hip && p.hip.torque > 0.0 && (p.hip.in_steps || !p.strategies.step);
}

/// sqrt((g + zdd) / z_c) with zdd = 0: natural frequency of the LIPM [1/s]; eq. (2).
inline double natural_frequency(const Parameters& p) { return std::sqrt(p.gravity / p.com_height); }

}  // namespace stagger::engine
