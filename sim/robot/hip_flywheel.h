// What the engine's hip strategy may reckon with: the upper body as a flywheel.
#pragma once

#include "engine/parameters.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

/// Angular momentum about the CoM for each rad/s by which the trunk leans over feet and CoM that
/// stay where they are: the legs turn against it. The less of forwards and sideways [kg m^2].
double lean_inertia(const Robot& robot);

/// Torque and speed are half of what the weaker of the hips' pitch and roll motors gives; the
/// inertia is lean_inertia(). No torque, and so no hip strategy, when the legs have no
/// such joints.
engine::HipParameters hip_flywheel(const Robot& robot);

}  // namespace stagger::sim
