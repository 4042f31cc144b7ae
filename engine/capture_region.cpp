#include "engine/capture_region.h"

#include "engine/capturability.h"

namespace stagger::engine {
namespace {

/// Of the sole, what later steps are reckoned to need at most: the rest is for errors.
constexpr double kept_share = 0.9;

}  // namespace

CaptureRegion::CaptureRegion(const Parameters& parameters, const ReachRegion& reach) {
  for (const bool free_times : {false, true}) {
    StepAbility ability = step_ability(parameters, reach, free_times);
    ability.sole = scaled(ability.sole, kept_share);
    const ConvexSet left = viable_dcm(ability);
    polygons_[free_times ? 1 : 0] = {inner_polygon(left), inner_polygon(mirrored(left))};
  }
}

}  // namespace stagger::engine
