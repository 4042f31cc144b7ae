// What comes out of the engine: everything that a body needs to walk this tick.
#pragma once

#include "engine/types.h"

namespace stagger::engine {

/// Target of one foot: pose of the sole with its derivatives, world frame.
struct FootTarget {
  Vec3 position = Vec3::Zero();      ///< [m]
  Vec3 velocity = Vec3::Zero();      ///< [m/s]
  Vec3 acceleration = Vec3::Zero();  ///< [m/s^2]
  double yaw = 0.0;                  ///< [rad]
  double yaw_velocity = 0.0;         ///< [rad/s]
  double yaw_acceleration = 0.0;     ///< [rad/s^2]
  bool in_contact = true;            ///< the foot is meant to stand and may carry load
};

/// How many steps ahead the targets tell of.
inline constexpr std::size_t preview_steps = 4;

struct WalkingTargets {
  WalkingState state = WalkingState::idle;
  Side support_side = Side::left;  ///< stance foot; in double support the foot that the ZMP leaves
  double phase_time = 0.0;    ///< t of eq. (1): since the start of this step's single support [s]
  double t_ss = 0.0;          ///< single support duration of this step, adjusted [s]
  double planned_t_ss = 0.0;  ///< the same before adjustment [s]
  double t_ds = 0.0;          ///< double support duration of this step [s]
  std::uint64_t step_count = 0;  ///< steps landed since the engine was made
  bool recovering = false;       ///< it steps because standing would have been a fall

  Vec2 zmp_reference = Vec2::Zero();           ///< eq. (1) [m]
  Vec2 com_reference = Vec2::Zero();           ///< [m]
  Vec2 com_velocity_reference = Vec2::Zero();  ///< [m/s]
  Vec2 dcm_reference = Vec2::Zero();           ///< [m]
  Vec2 com_estimate = Vec2::Zero();            ///< Kalman filter [m]
  Vec2 dcm_estimate = Vec2::Zero();            ///< Kalman filter [m]
  Vec2 zmp_command = Vec2::Zero();             ///< LQG output inside the support polygon [m]
  Vec2 zmp_shift = Vec2::Zero();               ///< hip strategy: torque / (m g), world axes [m]
  // Lean of the upper body that goes with it: about +y and about -x of the heading.
  Vec2 hip_angle = Vec2::Zero();         ///< [rad]
  Vec2 hip_rate = Vec2::Zero();          ///< [rad/s]
  Vec2 hip_acceleration = Vec2::Zero();  ///< [rad/s^2]
  double com_height = 0.0;               ///< above the ground under the stance foot [m]
  Vec2 ground_slope = Vec2::Zero();      ///< of the ground where it is not known yet, world axes
  double heading = 0.0;                  ///< yaw for pelvis and torso [rad]
  double heading_velocity = 0.0;         ///< [rad/s]

  PerFoot<FootTarget> feet;
  Footstep planned_step;   ///< next foothold before adjustment
  Footstep adjusted_step;  ///< next foothold after adjustment: where the swing foot goes
  std::array<Footstep, preview_steps> preview;  ///< the steps to come; [0] is adjusted_step
  std::size_t preview_count = 0;                ///< how many of preview are valid
};

}  // namespace stagger::engine
