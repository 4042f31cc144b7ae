// The area in which the ZMP can be: the hull of the soles that stand.
#pragma once

#include "engine/convex_polygon.h"

namespace stagger::engine {

/// A rectangle on the ground: the sole of one foot.
struct Sole {
  double half_length = 0.0;  ///< along the foot's x [m]
  double half_width = 0.0;   ///< along the foot's y [m]
};

ConvexPolygon support_polygon(const Sole& sole, const FootPose& foot);
ConvexPolygon support_polygon(const Sole& sole, const FootPose& first, const FootPose& second);

}  // namespace stagger::engine
