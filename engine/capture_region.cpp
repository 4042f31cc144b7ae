#include "engine/capture_region.h"

#include <numbers>

#include "engine/capturability.h"

namespace stagger::engine {
namespace {

ConvexSet corners(const ConvexPolygon& polygon) {
  ConvexSet set;
  for (std::size_t i = 0; i < polygon.size(); ++i) set.push_back(polygon.vertex(i));
  return set;
}

/// Of the sole, what later steps are reckoned to need at most: the rest is for errors.
constexpr double kept_share = 0.9;

/// The corners that lie farthest out in as many directions as a polygon can have corners.
ConvexPolygon within(const ConvexSet& set) {
  std::array<Vec2, ConvexPolygon::capacity> points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Not along the axes: of a box's corners each is then the farthest in two directions.
    const double angle = 2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) /
                         static_cast<double>(points.size());
    const Vec2 direction(std::cos(angle), std::sin(angle));
    points[i] = set.front();
    for (const Vec2& corner : set) {
      if (direction.dot(corner) > direction.dot(points[i])) points[i] = corner;
    }
  }
  return ConvexPolygon(points);
}

}  // namespace

CaptureRegion::CaptureRegion(const Parameters& p, const ReachRegion& reach) {
  const double x = kept_share * (p.foot_half_length - p.sole_margin);
  const double y = kept_share * (p.foot_half_width - p.sole_margin);
  StepAbility ability;
  ability.omega = natural_frequency(p);
  ability.sole = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  ability.reach = corners(reach.polygon(Side::left));
  ability.t_ss = p.t_ss;
  ability.t_ds = p.t_ds;
  if (p.strategies.time) ability.sooner = ability.later = p.time_limit;
  const ConvexSet left = viable_dcm(ability);
  polygons_ = {within(left), within(mirrored(left))};
}

}  // namespace stagger::engine
