// Where the feet go: the next footstep from the stance foot and the commanded velocity.
#pragma once

#include "engine/parameters.h"

namespace stagger::engine {

/// The step that follows `stance` when walking with `command`, `step_time` = T_ss + T_ds [s].
/// A sideways velocity widens the leading foot's steps and leaves the trailing foot's as they are,
/// so that the feet never come closer than the stance width.
Footstep next_footstep(const Footstep& stance, const WalkCommand& command, double step_time,
                       const Parameters& parameters);

/// Moves a foothold into the area that the leg can reach from the stance foot, in the stance foot's
/// frame: |x| <= max_step_length, lateral distance in [min_step_width, max_step_width].
Vec2 clamp_to_reach(const Footstep& stance, const Vec2& foothold, const Parameters& parameters);

}  // namespace stagger::engine
