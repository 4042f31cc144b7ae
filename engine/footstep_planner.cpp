#include "engine/footstep_planner.h"

#include <algorithm>

namespace stagger::engine {

Footstep next_footstep(const Footstep& stance, const WalkCommand& command, double step_time,
                       const Parameters& parameters) {
  Footstep next;
  next.side = other(stance.side);
  next.yaw = stance.yaw + command.wz * step_time;
  const double outward = lateral_sign(next.side);
  // Two steps bring the trailing foot along: the leading foot takes the whole way of both.
  const double side_step = command.vy * outward > 0.0 ? 2.0 * command.vy * step_time : 0.0;
  const Vec2 offset(command.vx * step_time, outward * parameters.stance_width + side_step);
  next.position = clamp_to_reach(stance, stance.position + rotated(offset, next.yaw), parameters);
  return next;
}

Vec2 clamp_to_reach(const Footstep& stance, const Vec2& foothold, const Parameters& parameters) {
  const double outward = lateral_sign(other(stance.side));
  Vec2 step = rotated(foothold - stance.position, -stance.yaw);
  step.x() = std::clamp(step.x(), -parameters.max_step_length, parameters.max_step_length);
  const double width =
      std::clamp(outward * step.y(), parameters.min_step_width, parameters.max_step_width);
  step.y() = outward * width;
  return stance.position + rotated(step, stance.yaw);
}

}  // namespace stagger::engine
