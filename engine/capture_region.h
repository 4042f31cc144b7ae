// Where the DCM may be at lift-off for the walk to go on, as polygons for the tick.
#pragma once

#include "engine/parameters.h"
#include "engine/reach.h"

namespace stagger::engine {

/// viable_dcm() for the parameters' sole, reach and nominal step times: one polygon for each stance
/// foot, in that foot's frame. A region of more than eight corners is cut down to eight of them, so
/// that what lies inside is still viable.
class CaptureRegion {
 public:
  CaptureRegion(const Parameters& parameters, const ReachRegion& reach);

  const ConvexPolygon& polygon(Side stance) const { return polygons_[index(stance)]; }

 private:
  PerFoot<ConvexPolygon> polygons_;
};

}  // namespace stagger::engine
