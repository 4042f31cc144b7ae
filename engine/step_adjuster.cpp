#include "engine/step_adjuster.h"

#include <algorithm>

#include "engine/step_limits.h"

namespace stagger::engine {

CatchingLine catching_line(const StepSituation& s) {
  // e^{-w Tds} b, told by what the plan wants at touchdown.
  const Vec2 offset =
      s.nominal_dcm - s.stance.position - s.transfer * (s.planned.position - s.stance.position);
  return {s.stance.position - offset / s.transfer, (s.dcm - s.stance.position) / s.transfer};
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

  // Edge i is kept to where room[i] - slope[i] * growth >= 0: a growth is a point on a line, and
  // the line's part inside the polygon an interval.
  const double first = std::exp(omega * earliest);
  const double last = std::exp(omega * latest);
  double from = first;
  double to = last;
  std::array<double, ConvexPolygon::capacity> room{};
  std::array<double, ConvexPolygon::capacity> slope{};
  for (std::size_t i = 0; i < region.size(); ++i) {
    room[i] = region.offset(i) - region.normal(i).dot(base);
    slope[i] = region.normal(i).dot(ray);
    if (slope[i] > 0.0) {
      to = std::min(to, room[i] / slope[i]);
    } else if (slope[i] < 0.0) {
      from = std::max(from, room[i] / slope[i]);
    } else if (room[i] < 0.0) {
      to = first - 1.0;  // never
    }
  }
  if (from <= to) {
    return std::clamp(nominal, std::log(from) / omega, std::log(to) / omega);
  }

  // Nothing catches it: least violation. It is convex and piecewise linear in the growth, so its
  // minimum lies at an end or where two edges are equally far away.
  const auto violation = [&](double growth) {
    double worst = 0.0;
    for (std::size_t i = 0; i < region.size(); ++i) {
      worst = std::max(worst, slope[i] * growth - room[i]);
    }
    return worst;
  };
  double best = first;
  double least = violation(first);
  const auto consider = [&](double growth) {
    const double v = violation(growth);
    if (v < least) {
      least = v;
      best = growth;
    }
  };
  consider(last);
  for (std::size_t i = 0; i < region.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double growth = (room[i] - room[j]) / (slope[i] - slope[j]);
      if (growth > first && growth < last) consider(growth);
    }
  }
  return std::log(best) / omega;
}

}  // namespace stagger::engine
