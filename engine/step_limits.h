// What one step may be: reach of the leg, turn of the foot, distance between the soles.
#pragma once

#include <algorithm>

#include "engine/parameters.h"
#include "engine/reach.h"
#include "engine/support_polygon.h"

namespace stagger::engine {

/// Which limit a step breaks; the first in this order.
enum class StepFault : std::uint8_t {
  none,
  out_of_reach,    ///< not in the reach polygon, or not finite
  turns_too_far,   ///< more than max_step_turn from the stance foot
  soles_too_near,  ///< the soles overlap, or come nearer to each other than foot_clearance
};

/// The sole that keeps its distance: all of it, whatever margin the ZMP keeps inside.
inline Sole whole_sole(const Parameters& p) { return {p.foot_half_length, p.foot_half_width}; }

/// The part of it that the ZMP may be in.
inline Sole usable_sole(const Parameters& p) {
  return {std::min(p.foot_half_length - p.sole_margin, p.ankle_reach.x()),
          std::min(p.foot_half_width - p.sole_margin, p.ankle_reach.y())};
}

/// Can the other foot be put down on `step` while `stance` stands?
StepFault check_step(const Footstep& stance, const Footstep& step, const ReachRegion& reach,
                     const Parameters& parameters);

/// A step near `wanted` that keeps every limit: its turn cut to max_step_turn, its place the
/// nearest in the reach polygon and then, if the soles come too near to each other there, moved
/// straight away from the edge in the way. Where the polygon leaves no room for that the foot lands
/// parallel to the stance foot. `wanted` itself when it keeps the limits.
Footstep nearest_step(const Footstep& stance, const Footstep& wanted, const ReachRegion& reach,
                      const Parameters& parameters);

}  // namespace stagger::engine
