#include "engine/capture_region.h"

#include <limits>

#include "engine/capturability.h"

namespace stagger::engine {
namespace {

/// Of the sole, what later steps are reckoned to need at most: the rest is for errors.
constexpr double kept_share = 0.9;

/// Cut down to as many corners as a polygon can have, each time by the one that costs the least
/// area.
ConvexPolygon within(ConvexSet set) {
  while (set.size() > ConvexPolygon::capacity) {
    const std::size_t n = set.size();
    std::size_t least = 0;
    double least_area = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 before = set[(i + n - 1) % n] - set[i];
      const Vec2 after = set[(i + 1) % n] - set[i];
      const double area = std::abs(before.x() * after.y() - before.y() * after.x());
      if (area < least_area) {
        least_area = area;
        least = i;
      }
    }
    set.erase(set.begin() + static_cast<std::ptrdiff_t>(least));
  }
  return ConvexPolygon(set);
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
