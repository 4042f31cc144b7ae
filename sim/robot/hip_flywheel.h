// What the engine's hip strategy may reckon with: the upper body as a flywheel.
#pragma once

#include "engine/parameters.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

/// Torque and speed are half of what the weaker of the hips' pitch and roll motors gives; the
/// inertia is the angular momentum that the whole body has when its trunk leans by 1 rad/s over
/// feet and CoM that stay where they are. No torque, and so no hip strategy, when the legs have no
/// such joints.
engine::HipParameters hip_flywheel(const Robot& robot);

}  // namespace stagger::sim
