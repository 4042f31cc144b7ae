#include "engine/step_adjuster.h"

#include <algorithm>
#include <limits>

#include "engine/step_limits.h"

namespace stagger::engine {

CatchingLine catching_line(const StepSituation& s) {
  // e^{-w Tds} b, told by what the plan wants at touchdown.
  const Vec2 offset =
      s.nominal_dcm - s.stance.position - s.transfer * (s.planned.position - s.stance.position);
  const Vec2 zmp = s.stance.position + s.ankle;
  return {s.stance.position + (s.ankle - offset) / s.transfer, (s.dcm - zmp) / s.transfer};
}

Vec2 ankle_help(const StepSituation& situation, const Vec2& error, double time_left, double omega,
                const Sole& sole, double share) {
  const double gain = std::expm1(omega * time_left);
  if (gain <= 0.0) return situation.ankle;
  const double yaw = situation.stance.yaw;
  const Vec2 most = share * Vec2(sole.half_length, sole.half_width);
  const Vec2 wanted = situation.ankle + error * (situation.transfer / gain);
  return rotated(rotated(wanted, -yaw).cwiseMax(-most).cwiseMin(most), yaw);
}

StepAdjustment adjust_step(const StepSituation& situation, double time_left, double omega,
                           const ReachRegion& reach, const Parameters& parameters) {
  StepAdjustment result;
  result.step = situation.planned;
  result.error = catching_line(situation).foothold(std::exp(omega * time_left)) -
                 situation.planned.position;  // (10')
  result.adjusted = result.error.norm() > parameters.step_margin;
  if (result.adjusted) {
    const Vec2 wanted = situation.planned.position + parameters.step_gain * result.error;  // (11')
    result.step.position = wanted;
    result.step = nearest_step(situation.stance, result.step, reach, parameters);
  }
  return result;
}

double adjust_time(const StepSituation& situation, double nominal, double earliest, double latest,
                   double omega, const ReachRegion& reach) {
  const CatchingLine line = catching_line(situation);
  const Footstep& stance = situation.stance;
  const Vec2 base = rotated(line.base - stance.position, -stance.yaw);
  const Vec2 ray = rotated(line.ray, -stance.yaw);
  const ConvexPolygon& region = reach.polygon(stance.side);

  // Edge i is kept to where room - slope * growth >= 0: a growth is a point on a line, and the
  // line's part inside the polygon an interval.
  const double first = std::exp(omega * earliest);
  const double last = std::exp(omega * latest);
  double from = first;
  double to = last;
  for (std::size_t i = 0; i < region.size(); ++i) {
    const double room = region.offset(i) - region.normal(i).dot(base);
    const double slope = region.normal(i).dot(ray);
    if (slope > 0.0) {
      to = std::min(to, room / slope);
    } else if (slope < 0.0) {
      from = std::max(from, room / slope);
    } else if (room < 0.0) {
      to = first - 1.0;  // never
    }
  }
  if (from <= to) {
    return std::clamp(nominal, std::log(from) / omega, std::log(to) / omega);
  }

  // Nothing catches it: least distance, by the same measure as the step is then clamped. Its square
  // is convex and smooth in the growth, and along an edge the distance is linear: the minimum lies
  // at an end, where the line passes nearest to a vertex, or all along an edge that it is parallel
  // to.
  double best = std::exp(omega * nominal);
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double growth) {
    const Vec2 place = base + std::clamp(growth, first, last) * ray;
    const double distance = (place - region.clamp(place)).norm();
    // Of equals the first: no change of time for nothing.
    constexpr double rounding = 1e-12;
    if (distance < least - rounding) {
      least = distance;
      best = std::clamp(growth, first, last);
    }
  };
  consider(best);
  consider(first);
  consider(last);
  const double length = ray.squaredNorm();
  for (std::size_t i = 0; i < region.size() && length > 0.0; ++i) {
    consider((region.vertex(i) - base).dot(ray) / length);
  }
  return std::log(best) / omega;
}

}  // namespace stagger::engine
