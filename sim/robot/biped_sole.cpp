#include "sim/robot/biped_sole.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "sim/robot/biped_legs.h"
#include "sim/robot/support_points.h"

namespace stagger::sim {
namespace {

using engine::Vec2;

/// Points this far above the plane are part of it [m]: rounded figures, and the soft edge that any
/// real sole has.
constexpr double flat = 5e-4;
constexpr double greatest_tilt = 0.7;       // [rad]
constexpr double greatest_sole_turn = 0.5;  // [rad]
/// Turning the rectangle must gain this share of its area.
constexpr double worth_turning = 0.05;
constexpr double least_sole = 0.02;  // [m], of robot.json
/// Every triple of points is looked at: more of them are thinned out first.
constexpr std::size_t most_points = 80;
constexpr int cuts = 48;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Convex hull, counter-clockwise (Andrew's monotone chain); less than 3 points when it has no
/// area.
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Vec2> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull[hull.size() - 2]) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double area(const std::vector<Vec2>& hull) {
  double twice = 0.0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    twice += cross(hull[i], hull[(i + 1) % hull.size()]);
  }
  return 0.5 * twice;
}

/// An upright frame at the plane with the normal `up`, x as near to `ahead` as it gets.
Eigen::Matrix3d frame_on(const Vec3& up, const Vec3& ahead) {
  Eigen::Matrix3d frame;
  frame.col(2) = up;
  frame.col(1) = up.cross(ahead).normalized();
  frame.col(0) = frame.col(1).cross(up);
  return frame;
}

struct Plane {
  Vec3 up = Vec3::UnitZ();
  double height = 0.0;  // along up
  double area = 0.0;
};

std::vector<Vec2> contact(const std::vector<Vec3>& points, const Plane& plane,
                          const Eigen::Matrix3d& frame) {
  std::vector<Vec2> inside;
  for (const Vec3& p : points) {
    if (plane.up.dot(p) > plane.height + flat) continue;
    inside.emplace_back(frame.col(0).dot(p), frame.col(1).dot(p));
  }
  return convex_hull(std::move(inside));
}

/// The plane with that normal that touches the points from below.
Plane touching(const std::vector<Vec3>& points, const Vec3& up, const Vec3& ahead) {
  Plane plane{up, std::numeric_limits<double>::infinity(), 0.0};
  for (const Vec3& p : points) plane.height = std::min(plane.height, up.dot(p));
  plane.area = area(contact(points, plane, frame_on(up, ahead)));
  return plane;
}

Plane best_plane(const std::vector<Vec3>& points, const Eigen::Matrix3d& axes) {
  const Vec3 ahead = axes.col(0);
  // Level is what most feet are, and free of the rounding errors of three points.
  Plane best = touching(points, axes.col(2), ahead);
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (std::size_t k = j + 1; k < n; ++k) {
        const Vec3 normal = (points[j] - points[i]).cross(points[k] - points[i]);
        if (normal.norm() < 1e-8) continue;
        Vec3 up = normal.normalized();
        if (up.dot(axes.col(2)) < 0.0) up = -up;
        if (up.dot(axes.col(2)) < std::cos(greatest_tilt)) continue;
        const double height = up.dot(points[i]);
        const bool lowest = std::all_of(points.begin(), points.end(),
                                        [&](const Vec3& p) { return up.dot(p) > height - 1e-6; });
        if (!lowest) continue;
        const Plane plane = touching(points, up, ahead);
        if (plane.area > best.area * (1.0 + worth_turning)) best = plane;
      }
    }
  }
  return best;
}

struct Rectangle {
  Vec2 low = Vec2::Zero();
  Vec2 high = Vec2::Zero();
  double area() const {
    const Vec2 size = high - low;
    return size.minCoeff() > 0.0 ? size.x() * size.y() : 0.0;
  }
};

/// Lowest and highest y of a convex polygon at x.
Vec2 range_at(const std::vector<Vec2>& hull, double x) {
  Vec2 range(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2& a = hull[i];
    const Vec2& b = hull[(i + 1) % hull.size()];
    // The ends of an edge at one x are those of its neighbours.
    if (a.x() == b.x() || x < std::min(a.x(), b.x()) || x > std::max(a.x(), b.x())) continue;
    const double y = a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
    range = {std::min(range[0], y), std::max(range[1], y)};
  }
  return range;
}

/// The greatest rectangle along the axes: its ends are at the corners of the polygon or at one of
/// `cuts` places between.
Rectangle greatest_inside(const std::vector<Vec2>& hull) {
  Rectangle best;
  if (hull.size() < 3) return best;
  std::vector<double> ends;
  ends.reserve(hull.size() + cuts);
  for (const Vec2& p : hull) ends.push_back(p.x());
  const auto [low, high] = std::minmax_element(ends.begin(), ends.end());
  const double first = *low;
  const double last = *high;
  for (int i = 1; i < cuts; ++i) ends.push_back(first + (last - first) * i / cuts);
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const Vec2 back = range_at(hull, ends[i]);
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      const Vec2 front = range_at(hull, ends[j]);
      const Rectangle now{{ends[i], std::max(back[0], front[0])},
                          {ends[j], std::min(back[1], front[1])}};
      if (now.area() > best.area() * (1.0 + 1e-9)) best = now;
    }
  }
  return best;
}

std::vector<Vec3> thinned(const std::vector<Vec3>& points, const Eigen::Matrix3d& axes) {
  if (points.size() <= most_points) return points;
  // What is high above the lowest point is no part of an underside.
  std::vector<Vec3> sorted = points;
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Vec3& a, const Vec3& b) {
    return axes.col(2).dot(a) < axes.col(2).dot(b);
  });
  sorted.resize(most_points);
  return sorted;
}

}  // namespace

FoundSole find_sole(const Body& foot, const Eigen::Matrix3d& axes) {
  if (foot.shapes.empty()) {
    throw CannotWalk("the foot '" + foot.name +
                     "' has no collision geometry: nothing tells how large its sole is");
  }
  Plane plane{axes.col(2), 0.0, 0.0};
  std::vector<Vec3> points;
  // What is round touches elsewhere when the plane turns: a second look finds it there.
  for (int pass = 0; pass < 3; ++pass) {
    points = support_points(foot.shapes, Eigen::Isometry3d::Identity(), plane.up);
    const Plane next = best_plane(thinned(points, axes), axes);
    const bool settled = (next.up - plane.up).norm() < 1e-9;
    plane = next;
    if (settled) break;
  }
  plane = touching(points, plane.up, axes.col(0));

  const Eigen::Matrix3d straight = frame_on(plane.up, axes.col(0));
  const std::vector<Vec2> hull = contact(points, plane, straight);
  Rectangle best = greatest_inside(hull);
  double best_turn = 0.0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 edge = hull[(i + 1) % hull.size()] - hull[i];
    double turn = std::atan2(edge.y(), edge.x());
    turn -= 0.5 * M_PI * std::round(turn / (0.5 * M_PI));
    if (std::abs(turn) > greatest_sole_turn || std::abs(turn) < 1e-3) continue;
    std::vector<Vec2> turned;
    turned.reserve(hull.size());
    for (const Vec2& p : hull) turned.emplace_back(Eigen::Rotation2Dd(-turn) * p);
    const Rectangle now = greatest_inside(turned);
    if (now.area() <= best.area() * (1.0 + worth_turning)) continue;
    best = now;
    best_turn = turn;
  }

  FoundSole sole;
  sole.length = (best.high - best.low).x();
  sole.width = (best.high - best.low).y();
  if (!(best.area() > 0.0) || sole.length < least_sole || sole.width < least_sole) {
    std::ostringstream text;
    text << "the foot '" << foot.name << "' touches the ground in a point or a line: its sole is "
         << std::max(0.0, sole.length) << " m x " << std::max(0.0, sole.width)
         << " m; allowed: at least " << least_sole << " m each";
    throw CannotWalk(text.str());
  }
  sole.pose.linear() = straight * Eigen::AngleAxisd(best_turn, Vec3::UnitZ()).toRotationMatrix();
  const Vec2 centre = 0.5 * (best.low + best.high);
  sole.pose.translation() = sole.pose.linear() * Vec3(centre.x(), centre.y(), plane.height);
  sole.tilt = std::acos(std::clamp(plane.up.dot(axes.col(2)), -1.0, 1.0));
  return sole;
}

}  // namespace stagger::sim
