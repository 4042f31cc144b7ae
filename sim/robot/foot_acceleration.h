// How quickly a leg's motors can move its foot.
#pragma once

#include "sim/robot/robot.h"

namespace stagger::sim {

/// Acceleration that the legs have the torque to give a foot, forwards and sideways, the least of
/// both feet and both ways: as the robot walks, with a base that does not move [m/s^2]. +infinity
/// of joints without a limit.
double foot_acceleration(const Robot& robot);

}  // namespace stagger::sim
