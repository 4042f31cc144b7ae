// A robot at rest on ground that is not level.
#pragma once

#include "sim/robot/robot.h"

namespace stagger::sim {

/// Stands like walking_state() does, trunk upright and centre of mass over the world's origin, but
/// on the plane through the origin with this unit normal: both soles lie on it, where they stand in
/// that state as seen from above. Legs that cannot tilt their feet come as near as they can.
RobotState slope_state(const Robot& robot, const Vec3& normal);

}  // namespace stagger::sim
