#include "engine/convex_set.h"

#include <algorithm>
#include <limits>

namespace stagger::engine {
namespace {

constexpr double corner_rounding = 1e-12;  // [m]

/// Is b so near to the segment from a to c, or to its wrong side, that the hull can do without it?
bool superfluous(const Vec2& a, const Vec2& b, const Vec2& c) {
  return cross(b - a, c - a) <= corner_rounding * (c - a).norm();
}

}  // namespace

ConvexSet corners(const ConvexPolygon& polygon) {
  ConvexSet set;
  for (std::size_t i = 0; i < polygon.size(); ++i) set.push_back(polygon.vertex(i));
  return set;
}

ConvexSet convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  const auto same = [](const Vec2& a, const Vec2& b) { return (a - b).norm() < corner_rounding; };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  if (points.size() < 3) return points;
  ConvexSet hull;
  const auto add = [&hull](const Vec2& p, std::size_t floor) {
    while (hull.size() >= floor + 2 && superfluous(hull[hull.size() - 2], hull.back(), p)) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Vec2& p : points) add(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.pop_back();  // the first point once more
  return hull;
}

ConvexSet hull_of(const ConvexSet& a, const ConvexSet& b) {
  std::vector<Vec2> points = a;
  points.insert(points.end(), b.begin(), b.end());
  return convex_hull(std::move(points));
}

ConvexPolygon inner_polygon(ConvexSet set) {
  while (set.size() > ConvexPolygon::capacity) {
    const std::size_t n = set.size();
    std::size_t least = 0;
    double least_area = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 before = set[(i + n - 1) % n] - set[i];
      const Vec2 after = set[(i + 1) % n] - set[i];
      const double area = std::abs(before.x() * after.y() - before.y() * after.x());
      if (area < least_area) {
        least_area = area;
        least = i;
      }
    }
    set.erase(set.begin() + static_cast<std::ptrdiff_t>(least));
  }
  return ConvexPolygon(set);
}

ConvexSet minkowski_sum(const ConvexSet& a, const ConvexSet& b) {
  std::vector<Vec2> points;
  points.reserve(a.size() * b.size());
  for (const Vec2& p : a) {
    for (const Vec2& q : b) points.emplace_back(p + q);
  }
  return convex_hull(std::move(points));
}

ConvexSet scaled(const ConvexSet& set, double factor) {
  ConvexSet result;
  result.reserve(set.size());
  for (const Vec2& p : set) result.emplace_back(factor * p);
  return result;
}

ConvexSet shifted(const ConvexSet& set, const Vec2& by) {
  ConvexSet result;
  result.reserve(set.size());
  for (const Vec2& p : set) result.emplace_back(p + by);
  return result;
}

ConvexSet mirrored(const ConvexSet& set) {
  ConvexSet result = set;
  for (Vec2& p : result) p.y() = -p.y();
  std::reverse(result.begin(), result.end());  // the mirror turns the order of the corners around
  return result;
}

double ray_exit(const ConvexSet& set, const Vec2& direction) {
  // Every edge keeps t * direction on its left: an interval of t is left over.
  double low = 0.0;
  double high = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Vec2& a = set[i];
    const Vec2 edge = set[(i + 1) % set.size()] - a;
    const double rate = cross(edge, direction);
    const double room = -cross(edge, a);  // inside: rate * t + room >= 0
    if (rate < 0.0) {
      high = std::min(high, -room / rate);
    } else if (rate > 0.0) {
      low = std::max(low, -room / rate);
    } else if (room < 0.0) {
      return -1.0;
    }
  }
  return low <= high && set.size() >= 3 ? high : -1.0;
}

double margin(const ConvexSet& set, const Vec2& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Vec2 edge = set[(i + 1) % set.size()] - set[i];
    least = std::min(least, cross(edge, point - set[i]) / edge.norm());
  }
  return least;
}

}  // namespace stagger::engine
