#include "engine/reach.h"

namespace stagger::engine {
namespace {

ConvexPolygon box(const Parameters& p) {
  const std::array<Vec2, 4> corners{
      Vec2(-p.max_step_back, -p.max_step_width), Vec2(p.max_step_length, -p.max_step_width),
      Vec2(p.max_step_length, -p.min_step_width), Vec2(-p.max_step_back, -p.min_step_width)};
  return ConvexPolygon(corners);
}

ConvexPolygon stretched(const ConvexPolygon& polygon, const Vec2& factors) {
  std::array<Vec2, ConvexPolygon::capacity> points;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    points[i] = polygon.vertex(i).cwiseProduct(factors);
  }
  return ConvexPolygon(std::span(points).first(polygon.size()));
}

}  // namespace

ReachRegion::ReachRegion(const Parameters& parameters) : ReachRegion(box(parameters)) {}

ReachRegion::ReachRegion(const ConvexPolygon& left_stance)
    : polygons_{left_stance, stretched(left_stance, {1.0, -1.0})} {}

ReachRegion ReachRegion::scaled_length(double share) const {
  return ReachRegion(stretched(polygon(Side::left), {share, 1.0}));
}

Vec2 ReachRegion::clamp(const Footstep& stance, const Vec2& foothold) const {
  const Vec2 step = rotated(foothold - stance.position, -stance.yaw);
  return stance.position + rotated(polygon(stance.side).clamp(step), stance.yaw);
}

}  // namespace stagger::engine
