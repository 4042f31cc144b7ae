// The area in which the ZMP can be: the hull of the soles that stand.
#pragma once

#include "engine/types.h"

namespace stagger::engine {

/// A rectangle on the ground: the sole of one foot.
struct Sole {
  double half_length = 0.0;  ///< along the foot's x [m]
  double half_width = 0.0;   ///< along the foot's y [m]
};

/// Convex polygon of at most eight vertices, counter-clockwise. No heap.
class SupportPolygon {
 public:
  static constexpr std::size_t capacity = 8;

  SupportPolygon() = default;
  /// Hull of one sole.
  SupportPolygon(const Sole& sole, const FootPose& foot);
  /// Hull of two soles.
  SupportPolygon(const Sole& sole, const FootPose& first, const FootPose& second);

  std::size_t size() const { return size_; }
  const Vec2& vertex(std::size_t i) const { return vertices_[i]; }
  /// Distance to the nearest edge, negative outside [m].
  double margin(const Vec2& point) const;
  /// The point itself when inside, else the nearest point of the polygon.
  Vec2 clamp(const Vec2& point) const;

 private:
  void hull(std::array<Vec2, capacity>& points, std::size_t count);

  std::array<Vec2, capacity> vertices_;
  std::size_t size_ = 0;
};

}  // namespace stagger::engine
