// Where the DCM may be at lift-off for the walk to go on, as polygons for the tick.
#pragma once

#include "engine/parameters.h"
#include "engine/reach.h"

namespace stagger::engine {

/// viable_dcm() for 0.9 of the parameters' sole and their reach: one polygon for each stance foot,
/// in that foot's frame, with the nominal step times and with those that may be adjusted. A region
/// of more than eight corners is cut down to those eight that cost the least area; nothing is
/// added.
class CaptureRegion {
 public:
  CaptureRegion(const Parameters& parameters, const ReachRegion& reach);

  const ConvexPolygon& polygon(Side stance, bool free_times) const {
    return polygons_[free_times ? 1 : 0][index(stance)];
  }

 private:
  std::array<PerFoot<ConvexPolygon>, 2> polygons_;
};

}  // namespace stagger::engine
