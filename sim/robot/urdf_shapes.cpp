#include "sim/robot/urdf_shapes.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "sim/robot/mesh_file.h"

namespace stagger::sim {
namespace {

/// A sphere without a radius stands for a point of contact: this is near enough to one [m].
constexpr double point_radius = 1e-3;
/// A mesh that is greater than this has another unit than metres [m].
constexpr double greatest_mesh = 10.0;

std::string size_text(double size) {
  std::ostringstream text;
  text << "a size of its collision geometry is " << size << " m; allowed: more than 0 m";
  return text.str();
}

/// Sizes that are 0 or less are odd; what is not a number at all is an error.
void check_size(Shape& shape, ShapeResult& result) {
  const int sizes = shape.kind == Shape::Kind::box        ? 3
                    : shape.kind == Shape::Kind::cylinder ? 2
                                                          : 1;
  for (int i = 0; i < sizes; ++i) {
    const double size = shape.size[i];
    if (!std::isfinite(size)) throw std::runtime_error(size_text(size));
    if (size > 0.0) continue;
    result.what = size_text(size);
    result.mended = true;
    if (shape.kind == Shape::Kind::sphere && size == 0.0) {
      shape.size[0] = point_radius;
      result.answer = "taken as a sphere of 1 mm";
    } else {
      result.answer = geometry_left_out;
      result.left_out = true;
    }
    return;
  }
}

void leave_out(ShapeResult& result, std::string what) {
  result.what = std::move(what);
  result.answer = geometry_left_out;
  result.mended = true;
  result.left_out = true;
}

void read_hull(const urdf::Mesh& mesh, const Eigen::Matrix3d& to_world,
               const ImportOptions& options, Shape& shape, ShapeResult& result) {
  const Vec3 scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
  if (!scale.allFinite()) throw std::runtime_error("the scale of its mesh is not finite");
  result.uri = mesh.filename;
  const Trust trust = trust_in(options.folder);
  const auto file = find_mesh(mesh.filename, options.folder, trust);
  if (!file) {
    leave_out(result, "there is no file for its mesh " + mesh.filename);
    return;
  }
  std::vector<Vec3> points;
  try {
    points = read_mesh(*file, trust);
  } catch (const std::runtime_error& error) {
    leave_out(result, std::string("its mesh cannot be read: ") + error.what());
    return;
  }
  for (Vec3& point : points) point = point.cwiseProduct(scale);
  shape.kind = Shape::Kind::hull;
  shape.points = hull_points(points, (to_world * shape.pose.linear()).transpose() * Vec3::UnitZ());
  Vec3 low = shape.points[0];
  Vec3 high = low;
  for (const Vec3& point : shape.points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  shape.size = high - low;
  result.mesh = *file;
  if (!(shape.size.maxCoeff() <= greatest_mesh) || !(shape.size.maxCoeff() > 0.0)) {
    std::ostringstream text;
    text << "its mesh " << mesh.filename << " is " << shape.size.maxCoeff() << " m long at scale ["
         << scale.transpose() << "]; allowed: more than 0 to " << greatest_mesh << " m";
    leave_out(result, text.str());
  } else if (scale.minCoeff() < 0.0) {
    result.what = "its mesh has a negative scale";
    result.answer = "mirrored, as the file says";
  }
}

}  // namespace

Eigen::Isometry3d to_isometry(const urdf::Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const urdf::Rotation& r = pose.rotation;
  result.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  result.translation() = Vec3(pose.position.x, pose.position.y, pose.position.z);
  return result;
}

ShapeResult read_shape(const urdf::Collision& collision, const Eigen::Matrix3d& to_world,
                       const ImportOptions& options) {
  ShapeResult result;
  if (!collision.geometry) return result;
  Shape shape;
  shape.pose = to_isometry(collision.origin);
  const urdf::Geometry& geometry = *collision.geometry;
  if (geometry.type == urdf::Geometry::BOX) {
    const urdf::Vector3& dim = static_cast<const urdf::Box&>(geometry).dim;
    shape.kind = Shape::Kind::box;
    shape.size = Vec3(dim.x, dim.y, dim.z);
    check_size(shape, result);
  } else if (geometry.type == urdf::Geometry::CYLINDER) {
    const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
    shape.kind = Shape::Kind::cylinder;
    shape.size = Vec3(cylinder.radius, cylinder.length, 0.0);
    check_size(shape, result);
  } else if (geometry.type == urdf::Geometry::SPHERE) {
    shape.kind = Shape::Kind::sphere;
    shape.size = Vec3(static_cast<const urdf::Sphere&>(geometry).radius, 0.0, 0.0);
    check_size(shape, result);
  } else {
    read_hull(static_cast<const urdf::Mesh&>(geometry), to_world, options, shape, result);
  }
  if (options.mode == ImportMode::strict && result.mended) throw std::runtime_error(result.what);
  if (!result.left_out) result.shape = std::move(shape);
  return result;
}

}  // namespace stagger::sim
