#include "sim/robot/urdf_import.h"

#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace stagger::sim {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Eigen::Isometry3d to_isometry(const urdf::Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const urdf::Rotation& r = pose.rotation;
  result.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  result.translation() = Vec3(pose.position.x, pose.position.y, pose.position.z);
  return result;
}

/// Steiner's theorem: inertia about a point displaced by d from the centre of mass.
Eigen::Matrix3d displaced(const Eigen::Matrix3d& inertia, double mass, const Vec3& d) {
  return inertia + mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
}

class Importer {
 public:
  Importer(const urdf::ModelInterface& urdf, const std::string& origin)
      : urdf_(urdf), origin_(origin) {}

  RobotModel run() {
    model_.name = urdf_.getName();
    const urdf::LinkConstSharedPtr root = urdf_.getRoot();
    model_.bodies.emplace_back().name = root->name;
    add_link(*root, 0, Eigen::Isometry3d::Identity());
    for (const Body& body : model_.bodies) check_mass(body);
    return std::move(model_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(origin_ + ": " + what);
  }

  // Adds the link to a body and goes on to its children. `pose` is the link in the body's frame.
  void add_link(const urdf::Link& link, int body, const Eigen::Isometry3d& pose) {
    add_inertial(link, body, pose);
    for (const auto& collision : link.collision_array) add_shape(link, *collision, body, pose);
    for (const auto& joint : link.child_joints) add_joint(*joint, body, pose);
  }

  void add_inertial(const urdf::Link& link, int index, const Eigen::Isometry3d& pose) {
    LinkPlace place{index, pose, Vec3::Zero(), 0.0};
    if (link.inertial) {
      const urdf::Inertial& given = *link.inertial;
      Eigen::Matrix3d own;
      own << given.ixx, given.ixy, given.ixz, given.ixy, given.iyy, given.iyz, given.ixz, given.iyz,
          given.izz;
      if (!std::isfinite(given.mass) || given.mass < 0.0 || !own.allFinite()) {
        std::ostringstream text;
        text << "link '" << link.name << "': mass is " << given.mass
             << " kg; allowed: a finite mass of at least 0 kg and a finite inertia";
        fail(text.str());
      }
      const Eigen::Isometry3d in_link = to_isometry(given.origin);
      place.com = in_link.translation();
      place.mass = given.mass;
      const Eigen::Isometry3d in_body = pose * in_link;
      merge(model_.bodies[index], given.mass, in_body.translation(),
            in_body.linear() * own * in_body.linear().transpose());
    }
    model_.links[link.name] = place;
  }

  static void merge(Body& body, double mass, const Vec3& com, const Eigen::Matrix3d& inertia) {
    const double sum = body.mass + mass;
    const Vec3 joint_com =
        sum > 0.0 ? Vec3((body.mass * body.com + mass * com) / sum) : Vec3::Zero();
    body.inertia = displaced(body.inertia, body.mass, body.com - joint_com) +
                   displaced(inertia, mass, com - joint_com);
    body.com = joint_com;
    body.mass = sum;
  }

  void add_shape(const urdf::Link& link, const urdf::Collision& collision, int body,
                 const Eigen::Isometry3d& pose) {
    if (!collision.geometry) return;
    Shape shape;
    shape.pose = pose * to_isometry(collision.origin);
    const urdf::Geometry& geometry = *collision.geometry;
    if (geometry.type == urdf::Geometry::BOX) {
      const urdf::Vector3& dim = static_cast<const urdf::Box&>(geometry).dim;
      shape.kind = Shape::Kind::box;
      shape.size = Vec3(dim.x, dim.y, dim.z);
    } else if (geometry.type == urdf::Geometry::CYLINDER) {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      shape.kind = Shape::Kind::cylinder;
      shape.size = Vec3(cylinder.radius, cylinder.length, 0.0);
    } else if (geometry.type == urdf::Geometry::SPHERE) {
      shape.kind = Shape::Kind::sphere;
      shape.size = Vec3(static_cast<const urdf::Sphere&>(geometry).radius, 0.0, 0.0);
    } else {
      fail("link '" + link.name +
           "': mesh collision not supported yet; allowed: box, cylinder, sphere");
    }
    check_size(link, shape);
    model_.bodies[body].shapes.push_back(shape);
  }

  void check_size(const urdf::Link& link, const Shape& shape) const {
    const int sizes = shape.kind == Shape::Kind::box        ? 3
                      : shape.kind == Shape::Kind::cylinder ? 2
                                                            : 1;
    for (int i = 0; i < sizes; ++i) {
      if (!(shape.size[i] > 0.0) || !std::isfinite(shape.size[i])) {
        std::ostringstream text;
        text << "link '" << link.name << "': a size of its collision geometry is " << shape.size[i]
             << " m; allowed: more than 0 m";
        fail(text.str());
      }
    }
  }

  void add_joint(const urdf::Joint& joint, int body, const Eigen::Isometry3d& parent_pose) {
    const urdf::LinkConstSharedPtr child = urdf_.getLink(joint.child_link_name);
    const Eigen::Isometry3d placement =
        parent_pose * to_isometry(joint.parent_to_joint_origin_transform);
    switch (joint.type) {
      case urdf::Joint::FIXED:
        add_link(*child, body, placement);
        return;
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        break;
      case urdf::Joint::PRISMATIC:
        refuse_type(joint, "prismatic");
      case urdf::Joint::PLANAR:
        refuse_type(joint, "planar");
      case urdf::Joint::FLOATING:
        refuse_type(joint, "floating");
      default:
        refuse_type(joint, "unknown");
    }
    if (joint.mimic) {
      fail("joint '" + joint.name + "' mimics '" + joint.mimic->joint_name +
           "'; allowed: joints that move on their own");
    }
    Body carried;
    carried.name = child->name;
    carried.parent = body;
    carried.joint = joint.name;
    carried.placement = placement;
    carried.axis = unit_axis(joint);
    read_limits(joint, carried);
    const auto index = static_cast<int>(model_.bodies.size());
    model_.bodies.push_back(std::move(carried));
    add_link(*child, index, Eigen::Isometry3d::Identity());
  }

  [[noreturn]] void refuse_type(const urdf::Joint& joint, const std::string& type) const {
    fail("joint '" + joint.name + "' has type " + type + "; allowed: revolute, continuous, fixed");
  }

  Vec3 unit_axis(const urdf::Joint& joint) const {
    const Vec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
    if (!axis.allFinite() || axis.norm() < 1e-6) {
      std::ostringstream text;
      text << "joint '" << joint.name << "': axis is [" << axis.transpose()
           << "]; allowed: a vector that is not zero";
      fail(text.str());
    }
    return axis.normalized();
  }

  void read_limits(const urdf::Joint& joint, Body& body) const {
    body.lower = -infinity;
    body.upper = infinity;
    body.effort = infinity;
    body.velocity = infinity;
    if (!joint.limits) return;  // continuous joints need none
    const urdf::JointLimits& given = *joint.limits;
    const bool finite = std::isfinite(given.lower) && std::isfinite(given.upper) &&
                        std::isfinite(given.effort) && std::isfinite(given.velocity);
    if (!finite || given.effort < 0.0) {
      std::ostringstream text;
      text << "joint '" << joint.name << "': limits are lower " << given.lower << " rad, upper "
           << given.upper << " rad, effort " << given.effort << " N m, velocity " << given.velocity
           << " rad/s; allowed: finite numbers, effort of at least 0 N m";
      fail(text.str());
    }
    if (joint.type == urdf::Joint::REVOLUTE && given.lower < given.upper) {
      body.lower = given.lower;
      body.upper = given.upper;
    }
    body.effort = given.effort;
    // A joint that may not move at all would be a fixed joint: 0 stands for "not known".
    if (given.velocity > 0.0) body.velocity = given.velocity;
  }

  void check_mass(const Body& body) const {
    const std::string who = "body '" + body.name + "' (with all that is fixed to it)";
    if (!(body.mass > 0.0)) {
      std::ostringstream text;
      text << who << ": mass is " << body.mass
           << " kg; allowed: more than 0 kg, given in <inertial>";
      fail(text.str());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(body.inertia,
                                                                Eigen::EigenvaluesOnly);
    if (!(solver.eigenvalues().minCoeff() > 0.0)) {
      std::ostringstream text;
      text << who << ": principal moments of inertia are [" << solver.eigenvalues().transpose()
           << "] kg m^2; allowed: more than 0 kg m^2 each";
      fail(text.str());
    }
  }

  const urdf::ModelInterface& urdf_;
  const std::string& origin_;
  RobotModel model_;
};

}  // namespace

RobotModel import_urdf(const std::string& xml, const std::string& origin) {
  const urdf::ModelInterfaceSharedPtr urdf = urdf::parseURDF(xml);
  if (!urdf || !urdf->getRoot()) {
    throw std::runtime_error(origin +
                             ": is no URDF that urdfdom can read (its messages are above)");
  }
  return Importer(*urdf, origin).run();
}

RobotModel import_urdf_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file.string() + ": cannot be opened");
  const std::string xml{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return import_urdf(xml, file.string());
}

}  // namespace stagger::sim
