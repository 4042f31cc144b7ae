#include "engine/sole_gap.h"

#include <algorithm>
#include <limits>

namespace stagger::engine {
namespace {

/// Gaps between the shadows of both soles on each one's axes. Convex figures are apart where one of
/// these is positive, and the axes of rectangles are all that have to be looked at.
double widest_shadow_gap(const Sole& sole, const Vec2& offset, const Vec2& turned, double turn) {
  const double c = std::abs(std::cos(turn));
  const double s = std::abs(std::sin(turn));
  const double along = sole.half_length * (1.0 + c) + sole.half_width * s;
  const double across = sole.half_width * (1.0 + c) + sole.half_length * s;
  return std::max({std::abs(offset.x()) - along, std::abs(offset.y()) - across,
                   std::abs(turned.x()) - along, std::abs(turned.y()) - across});
}

/// Squared distance from a sole at the origin to the nearest corner of one at `offset`.
double nearest_corner(const Sole& sole, const Vec2& offset, double turn) {
  const Vec2 along = rotated({sole.half_length, 0.0}, turn);
  const Vec2 across = rotated({0.0, sole.half_width}, turn);
  double least = std::numeric_limits<double>::infinity();
  for (const Vec2& corner : {Vec2(offset + along + across), Vec2(offset + along - across),
                             Vec2(offset - along + across), Vec2(offset - along - across)}) {
    const double x = std::max(std::abs(corner.x()) - sole.half_length, 0.0);
    const double y = std::max(std::abs(corner.y()) - sole.half_width, 0.0);
    least = std::min(least, x * x + y * y);
  }
  return least;
}

double gap_beyond_shadows(const Sole& sole, const Vec2& offset, const Vec2& turned, double turn) {
  // Of two polygons that are apart, a corner of one is where they are nearest.
  const double corner_of_second = nearest_corner(sole, offset, turn);
  const double corner_of_first = nearest_corner(sole, -turned, -turn);
  return std::sqrt(std::min(corner_of_second, corner_of_first));
}

}  // namespace

double sole_gap(const Sole& sole, const Vec2& offset, double turn) {
  const Vec2 turned = rotated(offset, -turn);
  const double shadow = widest_shadow_gap(sole, offset, turned, turn);
  return shadow <= 0.0 ? shadow : gap_beyond_shadows(sole, offset, turned, turn);
}

bool soles_clear(const Sole& sole, const Vec2& offset, double turn, double clearance) {
  const double reach = sole.half_length + sole.half_width;  // no corner is farther from the centre
  const double apart = 2.0 * reach + clearance;
  if (offset.squaredNorm() >= apart * apart) return true;
  const Vec2 turned = rotated(offset, -turn);
  const double shadow = widest_shadow_gap(sole, offset, turned, turn);
  if (shadow >= clearance || shadow <= 0.0) return shadow >= clearance;
  return gap_beyond_shadows(sole, offset, turned, turn) >= clearance;
}

}  // namespace stagger::engine
