#include "engine/step_limits.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "engine/sole_gap.h"

namespace stagger::engine {
namespace {

constexpr double rounding = 1e-9;  // [m], [rad]

double turn_of(const Footstep& stance, const Footstep& step) {
  return std::remainder(step.yaw - stance.yaw, 2.0 * std::numbers::pi);
}

/// The nearest of the places straight away from an edge of either sole, in the stance foot's frame,
/// that the leg reaches. Returns false when it reaches none.
bool move_apart(const Sole& sole, double clearance, double turn, const ConvexPolygon& reach,
                Vec2& offset) {
  const double c = std::abs(std::cos(turn));
  const double s = std::abs(std::sin(turn));
  const double along = sole.half_length * (1.0 + c) + sole.half_width * s + clearance;
  const double across = sole.half_width * (1.0 + c) + sole.half_length * s + clearance;
  const Vec2 start = offset;
  double least = std::numeric_limits<double>::infinity();
  for (const double angle : {0.0, turn}) {
    for (int axis = 0; axis < 2; ++axis) {
      const Vec2 normal = rotated(axis == 0 ? Vec2::UnitX() : Vec2::UnitY(), angle);
      const double apart = axis == 0 ? along : across;
      for (const double way : {1.0, -1.0}) {
        const double distance = apart - way * normal.dot(start);
        const Vec2 place = start + distance * way * normal;
        if (distance < least && reach.margin(place) >= -rounding) {
          least = distance;
          offset = place;
        }
      }
    }
  }
  return std::isfinite(least);
}

}  // namespace

StepFault check_step(const Footstep& stance, const Footstep& step, const ReachRegion& reach,
                     const Parameters& parameters) {
  const Vec2 offset = rotated(step.position - stance.position, -stance.yaw);
  const double turn = turn_of(stance, step);
  // Written so that a NaN is a fault.
  if (!(reach.polygon(stance.side).margin(offset) >= -rounding) || !offset.allFinite()) {
    return StepFault::out_of_reach;
  }
  if (!(std::abs(turn) <= parameters.max_step_turn + rounding)) return StepFault::turns_too_far;
  const double clearance = std::max(parameters.foot_clearance - rounding, 0.0);
  if (!soles_clear(whole_sole(parameters), offset, turn, clearance)) {
    return StepFault::soles_too_near;
  }
  return StepFault::none;
}

Footstep nearest_step(const Footstep& stance, const Footstep& wanted, const ReachRegion& reach,
                      const Parameters& parameters) {
  Footstep step = wanted;
  double turn = turn_of(stance, step);
  if (std::abs(turn) > parameters.max_step_turn) {
    turn = std::clamp(turn, -parameters.max_step_turn, parameters.max_step_turn);
    step.yaw = stance.yaw + turn;
  }
  step.position = reach.clamp(stance, step.position);

  const Sole sole = whole_sole(parameters);
  Vec2 offset = rotated(step.position - stance.position, -stance.yaw);
  const double clearance = std::max(parameters.foot_clearance - rounding, 0.0);
  if (soles_clear(sole, offset, turn, clearance)) return step;
  const ConvexPolygon& region = reach.polygon(stance.side);
  if (!move_apart(sole, parameters.foot_clearance, turn, region, offset)) {
    step.yaw = stance.yaw;
    if (!soles_clear(sole, offset, 0.0, clearance)) {
      move_apart(sole, parameters.foot_clearance, 0.0, region, offset);
    }
  }
  step.position = stance.position + rotated(offset, stance.yaw);
  return step;
}

}  // namespace stagger::engine
