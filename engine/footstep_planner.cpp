#include "engine/footstep_planner.h"

namespace stagger::engine {

Footstep next_footstep(const Footstep& stance, const WalkCommand& command, double step_time,
                       double stance_width, const ReachRegion& reach) {
  Footstep next;
  next.side = other(stance.side);
  next.yaw = stance.yaw + command.wz * step_time;
  const double outward = lateral_sign(next.side);
  // Two steps bring the trailing foot along: the leading foot takes the whole way of both.
  const double side_step = command.vy * outward > 0.0 ? 2.0 * command.vy * step_time : 0.0;
  const Vec2 offset(command.vx * step_time, outward * stance_width + side_step);
  next.position = reach.clamp(stance, stance.position + rotated(offset, next.yaw));
  return next;
}

}  // namespace stagger::engine
