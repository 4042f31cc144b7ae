// How a robot holds its legs: the nominal pose, with the knees bent further where it walks lower.
#pragma once

#include <functional>

#include "sim/robot/rigid_body.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

/// A height of the robot in a state [m].
using Height = std::function<double(const RigidBody&)>;

/// The nominal pose when that height is at most `most` in it; else with hips, knees and ankles of
/// both legs turned until it is `most`: soles flat, torso as upright, the CoM as far forward of the
/// soles. The nominal pose also for a robot whose legs do not have three joints that turn forwards,
/// or that cannot bend so far within its limits.
RobotState lowered_state(const Robot& robot, const Height& height, double most);

/// Of the CoM above the soles in the nominal pose [m].
double nominal_com_height(const Robot& robot);

/// At rest with the CoM as high as the robot walks, or in the nominal pose if that is lower.
RobotState walking_state(const Robot& robot);

}  // namespace stagger::sim
