#include "engine/support_polygon.h"

namespace stagger::engine {
namespace {

void append_corners(const Sole& sole, const FootPose& foot, std::span<Vec2> corners) {
  const Vec2 along = rotated({sole.half_length, 0.0}, foot.yaw);
  const Vec2 across = rotated({0.0, sole.half_width}, foot.yaw);
  const Vec2 centre = foot.position.head<2>();
  corners[0] = centre - along - across;
  corners[1] = centre - along + across;
  corners[2] = centre + along - across;
  corners[3] = centre + along + across;
}

}  // namespace

ConvexPolygon support_polygon(const Sole& sole, const FootPose& foot) {
  std::array<Vec2, 4> corners;
  append_corners(sole, foot, corners);
  return ConvexPolygon(corners);
}

ConvexPolygon support_polygon(const Sole& sole, const FootPose& first, const FootPose& second) {
  std::array<Vec2, 8> corners;
  append_corners(sole, first, std::span(corners).first(4));
  append_corners(sole, second, std::span(corners).last(4));
  return ConvexPolygon(corners);
}

}  // namespace stagger::engine
