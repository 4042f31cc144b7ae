#include "sim/robot/support_points.h"

#include <cmath>

namespace stagger::sim {
namespace {

constexpr int rim_points = 16;

void add_box(const Shape& shape, const Eigen::Isometry3d& pose, std::vector<Vec3>& points) {
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      for (const double z : {-0.5, 0.5}) {
        points.emplace_back(pose * shape.size.cwiseProduct(Vec3(x, y, z)));
      }
    }
  }
}

void add_cylinder(const Shape& shape, const Eigen::Isometry3d& pose, const Vec3& up,
                  std::vector<Vec3>& points) {
  const double radius = shape.size.x();
  const Vec3 local_up = pose.linear().transpose() * up;
  const Vec3 down(-local_up.x(), -local_up.y(), 0.0);
  const bool lies = down.norm() > 0.7;
  for (const double z : {-0.5 * shape.size.y(), 0.5 * shape.size.y()}) {
    if (down.norm() > 1e-6) {
      const Vec3 low = radius * down.normalized();
      points.emplace_back(pose * Vec3(low.x(), low.y(), z));
    }
    if (lies) continue;  // it touches along a line
    for (int i = 0; i < rim_points; ++i) {
      const double angle = 2.0 * M_PI * i / rim_points;
      points.emplace_back(pose * Vec3(radius * std::cos(angle), radius * std::sin(angle), z));
    }
  }
}

}  // namespace

std::vector<Vec3> support_points(const std::vector<Shape>& shapes, const Eigen::Isometry3d& pose,
                                 const Vec3& up) {
  std::vector<Vec3> points;
  for (const Shape& shape : shapes) {
    const Eigen::Isometry3d at = pose * shape.pose;
    switch (shape.kind) {
      case Shape::Kind::box:
        add_box(shape, at, points);
        break;
      case Shape::Kind::cylinder:
        add_cylinder(shape, at, up, points);
        break;
      case Shape::Kind::sphere:
        points.emplace_back(at.translation() - shape.size.x() * up);
        break;
      case Shape::Kind::hull:
        for (const Vec3& point : shape.points) points.emplace_back(at * point);
        break;
    }
  }
  return points;
}

}  // namespace stagger::sim
