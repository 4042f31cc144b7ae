// A convex polygon on the ground: what the ZMP may do inside feet, and feet inside a leg's reach.
#pragma once

#include <span>

#include "engine/types.h"

namespace stagger::engine {

/// At most eight vertices, counter-clockwise. No heap.
class ConvexPolygon {
 public:
  static constexpr std::size_t capacity = 8;

  ConvexPolygon() = default;
  /// Hull of at most `capacity` points, at least three of them not on one line.
  explicit ConvexPolygon(std::span<const Vec2> points);

  std::size_t size() const { return size_; }
  const Vec2& vertex(std::size_t i) const { return vertices_[i]; }
  /// Points x of the polygon have normal(i) . x <= offset(i); the normals point outwards, unit.
  const Vec2& normal(std::size_t i) const { return normals_[i]; }
  double offset(std::size_t i) const { return offsets_[i]; }

  /// Distance to the nearest edge, negative outside [m].
  double margin(const Vec2& point) const;
  /// The point itself when inside, else the nearest point of the polygon.
  Vec2 clamp(const Vec2& point) const;

 private:
  std::array<Vec2, capacity> vertices_;
  std::array<Vec2, capacity> normals_;
  std::array<double, capacity> offsets_{};
  std::size_t size_ = 0;
};

}  // namespace stagger::engine
