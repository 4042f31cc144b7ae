// Where the feet go: the next footstep from the stance foot and the commanded velocity.
#pragma once

#include "engine/reach.h"

namespace stagger::engine {

/// The step that follows `stance` when walking with `command`, `step_time` = T_ss + T_ds [s].
/// A sideways velocity widens the leading foot's steps and leaves the trailing foot's as they are,
/// so that the feet never come closer than the stance width.
Footstep next_footstep(const Footstep& stance, const WalkCommand& command, double step_time,
                       double stance_width, const ReachRegion& reach);

}  // namespace stagger::engine
