// What a joint's motor can give at a joint speed.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/robot/robot_model.h"

namespace stagger::sim {

/// Torque range of a motor [N m].
struct TorqueRange {
  double lower = 0.0;
  double upper = 0.0;
};

/// Part of the velocity limit up to which the full effort is there. Our assumption: data sheets
/// show a flat current-limited part and then a fall to nothing at the no-load speed.
inline constexpr double full_effort_speed = 0.8;

/// The full effort either way, except that a torque that would speed the joint up further fades out
/// linearly between full_effort_speed and all of the velocity limit. Braking is never weakened.
inline TorqueRange available_torque(const Body& body, double joint_velocity) {
  TorqueRange range{-body.effort, body.effort};
  const double speed = std::abs(joint_velocity) / body.velocity;  // 0 when unlimited
  if (speed > full_effort_speed) {
    const double left = std::max(0.0, (1.0 - speed) / (1.0 - full_effort_speed));
    (joint_velocity > 0.0 ? range.upper : range.lower) *= left;
  }
  return range;
}

}  // namespace stagger::sim
