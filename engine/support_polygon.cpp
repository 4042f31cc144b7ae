#include "engine/support_polygon.h"

#include <algorithm>
#include <limits>

namespace stagger::engine {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

void append_corners(const Sole& sole, const FootPose& foot, std::array<Vec2, 8>& points,
                    std::size_t& count) {
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      const Vec2 corner = rotated({sx * sole.half_length, sy * sole.half_width}, foot.yaw);
      points[count++] = foot.position.head<2>() + corner;
    }
  }
}

}  // namespace

SupportPolygon::SupportPolygon(const Sole& sole, const FootPose& foot) {
  std::array<Vec2, capacity> points;
  std::size_t count = 0;
  append_corners(sole, foot, points, count);
  hull(points, count);
}

SupportPolygon::SupportPolygon(const Sole& sole, const FootPose& first, const FootPose& second) {
  std::array<Vec2, capacity> points;
  std::size_t count = 0;
  append_corners(sole, first, points, count);
  append_corners(sole, second, points, count);
  hull(points, count);
}

void SupportPolygon::hull(std::array<Vec2, capacity>& points, std::size_t count) {
  // Andrew's monotone chain.
  std::sort(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Vec2& a, const Vec2& b) {
              return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
            });
  std::array<Vec2, 2 * capacity> chain;
  std::size_t n = 0;
  const auto push = [&](const Vec2& p, std::size_t floor) {
    while (n >= floor + 2 && cross(chain[n - 1] - chain[n - 2], p - chain[n - 2]) <= 0.0) --n;
    chain[n++] = p;
  };
  for (std::size_t i = 0; i < count; ++i) push(points[i], 0);
  const std::size_t lower = n - 1;
  for (std::size_t i = count - 1; i-- > 0;) push(points[i], lower);
  size_ = n - 1;  // the last point repeats the first
  std::copy_n(chain.begin(), size_, vertices_.begin());
}

double SupportPolygon::margin(const Vec2& point) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size_; ++i) {
    const Vec2 edge = vertices_[(i + 1) % size_] - vertices_[i];
    least = std::min(least, cross(edge, point - vertices_[i]) / edge.norm());
  }
  return least;
}

Vec2 SupportPolygon::clamp(const Vec2& point) const {
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
