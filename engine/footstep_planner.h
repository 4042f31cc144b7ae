// Where the feet go: the steps of a walk with a commanded velocity, within the limits of the legs.
#pragma once

#include "engine/step_limits.h"
#include "engine/step_timing.h"

namespace stagger::engine {

/// The two steps that a walk repeats. Found once for a command; a tick only lays them out.
///
/// The body moves along the arc of the commanded velocity, by the same twist each step, and both
/// feet are put down at the same distance from it. So velocity and turning rate are on average the
/// commanded ones, exactly, and a turn on the spot is about the middle between the feet. To go
/// sideways the feet are put down wider by half of each step's way: then the leading foot takes the
/// whole way of both steps and the trailing foot comes back to the stance width.
struct StepPattern {
  WalkCommand command;      ///< what is walked: the wish, cut to the limits
  StepTimes times;          ///< of each step [s]
  double turn = 0.0;        ///< of a foot against the one that stands [rad]
  double half_width = 0.0;  ///< distance of both feet from the middle of the body, sideways [m]
  PerFoot<Vec2> offset{};   ///< of the next foot, by the foot that stands, in its frame [m]
};

/// The steps of a walk with `wish` that keep the limits of check_step().
///
/// Where the soles would come too near to each other (toes of a turn inwards, heels of a turn
/// outwards), or a foot too near to the edge of the reach polygon, both feet are put down wider,
/// no more than needed; the velocity stays. Where that does not help, all three parts of the
/// command are cut by the same factor, to the greatest within the limits: the robot follows the
/// path that it was asked for, slower. Parts that are not finite count as 0. A reach polygon that
/// has no room even for stepping in place gets its nearest places.
StepPattern step_pattern(const WalkCommand& wish, const ReachRegion& reach,
                         const Parameters& parameters);

/// The step that follows `stance`.
Footstep next_footstep(const Footstep& stance, const StepPattern& pattern);

}  // namespace stagger::engine
