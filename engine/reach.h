// Where the swing foot can land: a polygon for each support foot, in that foot's frame.
#pragma once

#include "engine/convex_polygon.h"
#include "engine/parameters.h"

namespace stagger::engine {

/// Footholds that the leg reaches and that neither cross nor crowd a parallel stance foot (unless
/// allow_crossing lets the region go on beyond it). Written for the left foot standing: x forward,
/// y to the left, so that the right foot's places have y < 0. The other leg's region is its mirror
/// image. Which way the feet point, and so how near the soles come, is for step_limits.h.
class ReachRegion {
 public:
  explicit ReachRegion(const Parameters& parameters);
  /// Any convex region, e.g. from a leg's kinematics.
  explicit ReachRegion(const ConvexPolygon& left_stance);

  /// The same with all steps this much shorter or longer, forward and backward; as wide as before.
  ReachRegion scaled_length(double share) const;

  /// In the frame of the stance foot.
  const ConvexPolygon& polygon(Side stance) const { return polygons_[index(stance)]; }
  /// The reachable place nearest to `foothold`, world frame.
  Vec2 clamp(const Footstep& stance, const Vec2& foothold) const;

 private:
  PerFoot<ConvexPolygon> polygons_;
};

}  // namespace stagger::engine
