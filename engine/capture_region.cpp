#include "engine/capture_region.h"

#include <numbers>

#include "engine/capturability.h"

namespace stagger::engine {
namespace {

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

CaptureRegion::CaptureRegion(const Parameters& parameters, const ReachRegion& reach) {
  for (const bool free_times : {false, true}) {
    StepAbility ability = step_ability(parameters, reach, free_times);
    ability.sole = scaled(ability.sole, kept_share);
    const ConvexSet left = viable_dcm(ability);
    polygons_[free_times ? 1 : 0] = {within(left), within(mirrored(left))};
  }
}

}  // namespace stagger::engine
