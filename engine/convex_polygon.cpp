#include "engine/convex_polygon.h"

#include <algorithm>
#include <limits>

namespace stagger::engine {
ConvexPolygon::ConvexPolygon(std::span<const Vec2> points) {
  // Andrew's monotone chain.
  std::array<Vec2, capacity> sorted;
  const std::size_t count = std::min(points.size(), capacity);
  std::copy_n(points.begin(), count, sorted.begin());
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Vec2& a, const Vec2& b) {
              return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
            });
  std::array<Vec2, 2 * capacity> chain;
  std::size_t n = 0;
  const auto push = [&](const Vec2& p, std::size_t floor) {
    while (n >= floor + 2 && cross(chain[n - 1] - chain[n - 2], p - chain[n - 2]) <= 0.0) --n;
    chain[n++] = p;
  };
  for (std::size_t i = 0; i < count; ++i) push(sorted[i], 0);
  const std::size_t lower = n - 1;
  for (std::size_t i = count - 1; i-- > 0;) push(sorted[i], lower);
  size_ = n - 1;  // the last point repeats the first
  std::copy_n(chain.begin(), size_, vertices_.begin());
  for (std::size_t i = 0; i < size_; ++i) {
    const Vec2 edge = (vertices_[(i + 1) % size_] - vertices_[i]).normalized();
    normals_[i] = {edge.y(), -edge.x()};
    offsets_[i] = normals_[i].dot(vertices_[i]);
  }
}

double ConvexPolygon::margin(const Vec2& point) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size_; ++i) {
    least = std::min(least, offsets_[i] - normals_[i].dot(point));
  }
  return least;
}

Vec2 ConvexPolygon::clamp(const Vec2& point) const {
  if (size_ == 0 || margin(point) >= 0.0) return point;
  Vec2 nearest = vertices_[0];
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size_; ++i) {
    const Vec2& a = vertices_[i];
    const Vec2 edge = vertices_[(i + 1) % size_] - a;
    const double s = std::clamp(edge.dot(point - a) / edge.squaredNorm(), 0.0, 1.0);
    const Vec2 candidate = a + s * edge;
    const double distance = (point - candidate).squaredNorm();
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace stagger::engine
