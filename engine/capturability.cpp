#include "engine/capturability.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/step_limits.h"

namespace stagger::engine {
namespace {

/// DCM at touchdown, from the left stance foot, such that the DCM at the next lift-off can be in
/// the mirror image of `next`, relative to the new foot.
ConvexSet at_touchdown(const StepAbility& ability, const ConvexSet& next) {
  // In double support the ZMP is free in the hull of both soles: from l f + sole, 0 <= l <= 1.
  // zeta_TD = a (f + next) + (1 - a)(l f + sole), a = e^{-w Tds}; over all l the factor of f runs
  // from a to 1, and the union of a * reach to 1 * reach is the hull of the two.
  const double a = std::exp(-ability.omega * ability.t_ds);
  const ConvexSet feet = hull_of(scaled(ability.reach, a), ability.reach);
  return minkowski_sum(minkowski_sum(feet, scaled(mirrored(next), a)),
                       scaled(ability.sole, 1.0 - a));
}

/// DCM `time` before one in `end`, the ZMP being free inside the sole.
ConvexSet before(const StepAbility& ability, const ConvexSet& end, double time) {
  const double g = std::exp(-ability.omega * time);
  return minkowski_sum(scaled(end, g), scaled(ability.sole, 1.0 - g));
}

ConvexSet before(const StepAbility& ability, const ConvexSet& end, double earliest, double latest) {
  const ConvexSet soon = before(ability, end, earliest);
  if (latest <= earliest) return soon;
  // In between every point moves on a straight line from the one to the other.
  return hull_of(soon, before(ability, end, latest));
}

}  // namespace

StepAbility step_ability(const Parameters& p, const ReachRegion& reach, bool free_times) {
  const auto [x, y] = usable_sole(p);
  StepAbility ability;
  ability.omega = natural_frequency(p);
  ability.sole = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  ability.reach = corners(reach.polygon(Side::left));
  ability.t_ss = p.t_ss;
  ability.t_ds = p.t_ds;
  if (free_times) {
    ability.sooner = std::min(p.time_limit, std::max(p.t_ss - p.least_t_ss, 0.0));
    ability.later = p.time_limit;
  }
  return ability;
}

ReachRegion rounded(const ReachRegion& reach, double width) {
  const ConvexPolygon& region = reach.polygon(Side::left);
  ConvexSet points;
  for (std::size_t i = 0; i < region.size(); ++i) {
    const Vec2& corner = region.vertex(i);
    if (-corner.y() <= width) {
      points.push_back(corner);
      continue;
    }
    // Three points of the ellipse, as far as the region holds them.
    for (const double angle : {0.0, 0.25 * std::numbers::pi, 0.5 * std::numbers::pi}) {
      const Vec2 point(std::cos(angle) * corner.x(),
                       -width + std::sin(angle) * (corner.y() + width));
      constexpr double rounding = 1e-9;  // [m]
      if (region.margin(point) >= -rounding) points.push_back(point);
    }
  }
  const ConvexSet hull = convex_hull(points);
  return hull.size() < 3 ? reach : ReachRegion(inner_polygon(hull));
}

ConvexSet viable_dcm(const StepAbility& ability) {
  // A contraction by e^{-w (Tss + Tds)} a step: it converges from wherever it begins.
  const double shortest = ability.t_ss - ability.sooner;
  const double decay = ability.omega * (shortest + ability.t_ds);
  if (!(decay > 0.0)) throw std::invalid_argument("capturability: steps that last no time");
  constexpr double digits = 32.0;  // e^-32: below what hulls are rounded to
  const int steps = static_cast<int>(std::ceil(digits / decay));
  ConvexSet viable = ability.sole;
  for (int i = 0; i < steps; ++i) {
    viable = before(ability, at_touchdown(ability, viable), shortest, ability.t_ss + ability.later);
  }
  return viable;
}

ConvexSet viable_dcm(const StepAbility& ability, double earliest, double latest) {
  return before(ability, at_touchdown(ability, viable_dcm(ability)), earliest, latest);
}

}  // namespace stagger::engine
