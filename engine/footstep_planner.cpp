#include "engine/footstep_planner.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "engine/sole_gap.h"

namespace stagger::engine {
namespace {

/// Halvings of an interval until its ends are a rounding error apart.
constexpr int halvings = 45;

/// Steps of one foot from the other as a function of how far the feet are from the body's middle:
/// start + half_width * way. In the frame of the foot that stands.
struct StepLine {
  Vec2 start;
  Vec2 way;
  double turn;

  Vec2 at(double half_width) const { return start + half_width * way; }
};

/// `outward`: +1 when the left foot steps.
StepLine step_line(const WalkCommand& command, double time, double outward) {
  const double turn = command.wz * time;
  // Way of the body at constant velocities in its own frame: an arc.
  const bool straight = std::abs(turn) < 1e-9;
  const double along = straight ? 1.0 : std::sin(turn) / turn;
  const double across = straight ? 0.5 * turn : (1.0 - std::cos(turn)) / turn;
  const Vec2 way = time * Vec2(along * command.vx - across * command.vy,
                               across * command.vx + along * command.vy);
  const Vec2 side(0.0, outward);
  return {way, side + rotated(side, turn), turn};
}

struct Range {
  double least;
  double most;
};

/// The half widths, of those in `range`, that put the foot into the polygon.
Range within(const ConvexPolygon& polygon, const StepLine& line, Range range) {
  constexpr double rounding = 1e-12;  // [m]
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const double room = polygon.offset(i) - polygon.normal(i).dot(line.start);
    const double slope = polygon.normal(i).dot(line.way);
    if (slope > rounding) {
      range.most = std::min(range.most, (room + rounding) / slope);
    } else if (slope < -rounding) {
      range.least = std::max(range.least, (room + rounding) / slope);
    } else if (room < -rounding) {
      range.most = -std::numeric_limits<double>::infinity();
    }
  }
  return range;
}

/// The least half width at which both steps of the command keep every limit, if there is one.
std::optional<double> half_width(const WalkCommand& command, double time, const ReachRegion& reach,
                                 const Parameters& p) {
  if (std::abs(command.wz) * time > p.max_step_turn) return std::nullopt;
  const double natural = 0.5 * (p.stance_width + std::abs(command.vy) * time);
  Range range{natural, std::numeric_limits<double>::max()};
  PerFoot<StepLine> lines{};
  for (const Side stance : {Side::left, Side::right}) {
    lines[index(stance)] = step_line(command, time, lateral_sign(other(stance)));
    range = within(reach.polygon(stance), lines[index(stance)], range);
  }
  if (range.least > range.most) return std::nullopt;
  const Sole sole = whole_sole(p);
  for (const StepLine& line : lines) {
    const auto clear = [&](double half) {
      return soles_clear(sole, line.at(half), line.turn, p.foot_clearance);
    };
    if (clear(range.least)) continue;
    // A distance between convex figures grows ever faster on a straight way outwards: so one
    // change.
    if (!clear(range.most)) return std::nullopt;
    double near = range.least;
    double apart = range.most;
    for (int i = 0; i < halvings; ++i) {
      const double half = 0.5 * (near + apart);
      (clear(half) ? apart : near) = half;
    }
    range.least = apart;
  }
  return range.least;
}

WalkCommand scaled(const WalkCommand& command, double share) {
  return {share * command.vx, share * command.vy, share * command.wz};
}

}  // namespace

StepPattern step_pattern(const WalkCommand& wish, const ReachRegion& reach,
                         const Parameters& parameters) {
  const auto finite = [](double v) { return std::isfinite(v) ? v : 0.0; };
  StepPattern pattern;
  pattern.command = {finite(wish.vx), finite(wish.vy), finite(wish.wz)};
  pattern.times = step_times(pattern.command, parameters);
  const double time = pattern.times.step();
  std::optional<double> half = half_width(pattern.command, time, reach, parameters);
  if (!half) {
    const WalkCommand whole = pattern.command;
    double share = 0.0;
    double too_much = 1.0;
    pattern.command = {};
    half = half_width(pattern.command, time, reach, parameters);
    const bool has_room = half.has_value();
    for (int i = 0; i < halvings && has_room; ++i) {
      const double middle = 0.5 * (share + too_much);
      const WalkCommand command = scaled(whole, middle);
      if (const auto found = half_width(command, time, reach, parameters)) {
        share = middle;
        pattern.command = command;
        half = found;
      } else {
        too_much = middle;
      }
    }
  }
  pattern.turn = pattern.command.wz * time;
  pattern.half_width = half.value_or(0.5 * parameters.stance_width);
  for (const Side stance : {Side::left, Side::right}) {
    const double outward = lateral_sign(other(stance));
    Vec2& offset = pattern.offset[index(stance)];
    offset = step_line(pattern.command, time, outward).at(pattern.half_width);
    if (half) continue;
    const Footstep origin{Vec2::Zero(), 0.0, stance};
    offset = nearest_step(origin, {offset, 0.0, other(stance)}, reach, parameters).position;
  }
  return pattern;
}

Footstep next_footstep(const Footstep& stance, const StepPattern& pattern) {
  const Vec2 offset = rotated(pattern.offset[index(stance.side)], stance.yaw);
  return {stance.position + offset, stance.yaw + pattern.turn, other(stance.side)};
}

}  // namespace stagger::engine
