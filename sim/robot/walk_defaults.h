// How a robot walks when its description does not say: by formula, from its proportions.
#pragma once

#include "sim/robot/biped_proportions.h"

namespace stagger::sim {

/// Durations are those of the reference robot (0.40 s single, 0.10 s double support at h = 1 m) in
/// units of sqrt(h / g); lengths are shares of the leg's length. Each constant's comment in the
/// source names what chose it.
WalkDescription walk_defaults(const BipedProportions& proportions);

/// The same from the robot's own model and nominal pose; its description's walk is not looked at.
WalkDescription walk_defaults(const Robot& robot);

}  // namespace stagger::sim
