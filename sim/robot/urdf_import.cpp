#include "sim/robot/urdf_import.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

#include "sim/robot/inertia.h"
#include "sim/robot/mesh_file.h"
#include "sim/robot/urdf_shapes.h"
#include "sim/robot/urdf_text.h"

namespace stagger::sim {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
/// Some CAD exports write masses like this for links that only mark a place [kg].
constexpr double marker_mass = 1e-4;
/// Names that a quirk of many links or joints tells.
constexpr std::size_t most_names = 3;
/// Links, and pieces of collision geometry, of a URDF that comes from a stranger.
constexpr std::size_t most_of_a_stranger = 500;

const char* type_name(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::PRISMATIC:
      return "prismatic";
    case urdf::Joint::PLANAR:
      return "planar";
    case urdf::Joint::FLOATING:
      return "floating";
    default:
      return "unknown";
  }
}

Eigen::Matrix3d own_inertia(const urdf::Inertial& given) {
  Eigen::Matrix3d own;
  own << given.ixx, given.ixy, given.ixz, given.ixy, given.iyy, given.iyz, given.ixz, given.iyz,
      given.izz;
  return own;
}

/// Quirks that links or joints have in common, told once with their names.
class QuirkList {
 public:
  void add(const std::string& kind, const std::string& name, std::string what, std::string answer) {
    for (Group& group : groups_) {
      if (group.kind != kind || group.what != what || group.answer != answer) continue;
      if (group.names.back() != name) group.names.push_back(name);
      return;
    }
    groups_.push_back({kind, {name}, std::move(what), std::move(answer)});
  }

  Quirks list() const {
    Quirks result;
    for (const Group& group : groups_) {
      std::string where = group.kind + (group.names.size() > 1 ? "s " : " ");
      for (std::size_t i = 0; i < group.names.size() && i < most_names; ++i) {
        where += (i == 0 ? "'" : ", '") + group.names[i] + "'";
      }
      if (group.names.size() > most_names) {
        where += " and " + std::to_string(group.names.size() - most_names) + " more";
      }
      result.push_back({std::move(where), group.what, group.answer});
    }
    return result;
  }

 private:
  struct Group {
    std::string kind;
    std::vector<std::string> names;
    std::string what;
    std::string answer;
  };
  std::vector<Group> groups_;
};

class Importer {
 public:
  Importer(const urdf::ModelInterface& urdf, const std::string& origin,
           const ImportOptions& options, ImportReport& report)
      : urdf_(urdf), origin_(origin), options_(options), report_(report) {}

  RobotModel run() {
    check_names();
    model_.name = urdf_.getName();
    const urdf::LinkConstSharedPtr root = urdf_.getRoot();
    model_.bodies.emplace_back().name = root->name;
    at_zero_.emplace_back(Eigen::Matrix3d::Identity());
    add_link(*root, 0, Eigen::Isometry3d::Identity());
    if (options_.mode == ImportMode::strict) {
      for (const Body& body : model_.bodies) check_mass(body);
    } else if (!(model_.mass() > 0.0)) {
      fail("no link has a mass; allowed: a robot that weighs something, given in <inertial>");
    }
    report_.quirks = quirks_.list();
    if (options_.mode != ImportMode::strict) report_.mended = mend_masses(model_);
    return std::move(model_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(origin_ + ": " + what);
  }

  void check_names() const {
    const auto check = [&](const std::string& name, const char* what) {
      if (urdf_.joints_.contains(name)) return;
      fail("has no joint '" + name + "', which is to be " + what);
    };
    for (const auto& [name, angle] : options_.locked) check(name, "locked");
    for (const auto& [name, limits] : options_.motors) check(name, "given other limits");
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
      const Eigen::Matrix3d own = own_inertia(given);
      const Eigen::Isometry3d in_link = to_isometry(given.origin);
      if (!std::isfinite(given.mass) || given.mass < 0.0 || !own.allFinite() ||
          !in_link.matrix().allFinite()) {
        std::ostringstream text;
        text << "link '" << link.name << "': mass is " << given.mass
             << " kg; allowed: a finite mass of at least 0 kg and a finite inertia";
        fail(text.str());
      }
      tell_inertial(link.name, given.mass, own);
      place.com = in_link.translation();
      place.mass = given.mass;
      const Eigen::Isometry3d in_body = pose * in_link;
      add_mass(model_.bodies[index], given.mass, in_body.translation(),
               in_body.linear() * own * in_body.linear().transpose());
    } else {
      quirks_.add("link", link.name, "no <inertial>", "taken as without mass");
    }
    model_.links[link.name] = place;
  }

  void tell_inertial(const std::string& link, double mass, const Eigen::Matrix3d& own) {
    if (mass < marker_mass) {
      quirks_.add("link", link, mass > 0.0 ? "weighs less than 0.1 g" : "<inertial> without mass",
                  "adds next to nothing to what it is fixed to");
    } else if (own.isZero(0.0)) {
      quirks_.add("link", link, "an inertia of zero", "taken as a point of its mass");
    } else if (!inertia_fault(own).empty()) {
      quirks_.add("link", link, "an inertia that no body has (triangle inequality)",
                  "kept: what counts is its sum with all that is fixed to it");
    }
  }

  void add_shape(const urdf::Link& link, const urdf::Collision& collision, int body,
                 const Eigen::Isometry3d& pose) {
    ShapeResult result;
    try {
      result = read_shape(collision, at_zero_[body] * pose.linear(), options_);
    } catch (const std::runtime_error& error) {
      fail("link '" + link.name + "': " + error.what());
    }
    if (!result.what.empty()) quirks_.add("link", link.name, result.what, result.answer);
    if (!result.mesh.empty()) report_.meshes[result.uri] = result.mesh;
    if (!result.shape) return;
    result.shape->pose = pose * result.shape->pose;
    if (!result.shape->pose.matrix().allFinite()) {
      fail("link '" + link.name + "': its collision geometry has a place that is not finite");
    }
    model_.bodies[body].shapes.push_back(std::move(*result.shape));
  }

  void add_joint(const urdf::Joint& joint, int body, const Eigen::Isometry3d& parent_pose) {
    const urdf::LinkConstSharedPtr child = urdf_.getLink(joint.child_link_name);
    const Eigen::Isometry3d placement =
        parent_pose * to_isometry(joint.parent_to_joint_origin_transform);
    if (!placement.matrix().allFinite()) {
      fail("joint '" + joint.name + "': its origin is not finite");
    }
    if (joint.type == urdf::Joint::FIXED || is_float(joint, body)) {
      add_link(*child, body, placement);
      return;
    }
    if (const auto locked = options_.locked.find(joint.name); locked != options_.locked.end()) {
      add_link(*child, body, placement * displacement(joint, locked->second));
      return;
    }
    if (joint.type != urdf::Joint::REVOLUTE && joint.type != urdf::Joint::CONTINUOUS) {
      if (options_.mode != ImportMode::survey) {
        fail("joint '" + joint.name + "' has type " + type_name(joint) +
             "; allowed: revolute, continuous, fixed");
      }
      report_.held[joint.name] = {type_name(joint), body};
      add_link(*child, body, placement);
      return;
    }
    check_mimic(joint);
    Body carried;
    carried.name = child->name;
    carried.parent = body;
    carried.joint = joint.name;
    carried.placement = placement;
    carried.axis = unit_axis(joint);
    read_limits(joint, carried);
    const auto index = static_cast<int>(model_.bodies.size());
    at_zero_.emplace_back(at_zero_[body] * placement.linear());
    model_.bodies.push_back(std::move(carried));
    add_link(*child, index, Eigen::Isometry3d::Identity());
  }

  /// A joint that lets the whole robot float, as the base does anyway?
  bool is_float(const urdf::Joint& joint, int body) {
    if (joint.type != urdf::Joint::FLOATING || body != 0 || model_.bodies[0].mass > 0.0 ||
        !model_.bodies[0].shapes.empty()) {
      return false;
    }
    quirks_.add("joint", joint.name, "floats below a root without mass",
                "taken as fixed: the base floats anyway");
    return true;
  }

  Eigen::Isometry3d displacement(const urdf::Joint& joint, double value) const {
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
    if (joint.type == urdf::Joint::PRISMATIC) {
      result.translation() = value * unit_axis(joint);
    } else if (joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS) {
      result.linear() = Eigen::AngleAxisd(value, unit_axis(joint)).toRotationMatrix();
    }
    return result;
  }

  void check_mimic(const urdf::Joint& joint) {
    if (!joint.mimic) return;
    if (options_.mode != ImportMode::survey) {
      fail("joint '" + joint.name + "' mimics '" + joint.mimic->joint_name +
           "'; allowed: joints that move on their own, and locked ones");
    }
    report_.mimics[joint.name] = joint.mimic->joint_name;
  }

  Vec3 unit_axis(const urdf::Joint& joint) const {
    const Vec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
    if (!axis.allFinite() || !(axis.norm() >= 1e-6) || !std::isfinite(axis.norm())) {
      std::ostringstream text;
      text << "joint '" << joint.name << "': axis is [" << axis.transpose()
           << "]; allowed: a vector that is not zero";
      fail(text.str());
    }
    return axis.normalized();
  }

  void read_limits(const urdf::Joint& joint, Body& body) {
    body.lower = -unlimited;
    body.upper = unlimited;
    body.effort = unlimited;
    body.velocity = unlimited;
    if (joint.limits) take_limits(joint, body);  // continuous joints need none
    if (const auto motor = options_.motors.find(joint.name); motor != options_.motors.end()) {
      body.effort = motor->second.effort.value_or(body.effort);
      body.velocity = motor->second.velocity.value_or(body.velocity);
    }
  }

  void take_limits(const urdf::Joint& joint, Body& body) {
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
    } else if (joint.type == urdf::Joint::REVOLUTE) {
      quirks_.add("joint", joint.name, "no range: lower is not less than upper",
                  "taken as without bounds");
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
  const ImportOptions& options_;
  ImportReport& report_;
  QuirkList quirks_;
  RobotModel model_;
  std::vector<Eigen::Matrix3d> at_zero_;  // orientation of every body with all joints at zero
};

/// What a stranger's robot may cost: every shape is one more for each tick of the physics.
void check_size(const urdf::ModelInterface& urdf, const std::string& origin) {
  std::size_t shapes = 0;
  for (const auto& [name, link] : urdf.links_) shapes += link->collision_array.size();
  const auto check = [&](std::size_t count, const char* what) {
    if (count <= most_of_a_stranger) return;
    throw std::runtime_error(origin + ": has " + std::to_string(count) + " " + what +
                             "; allowed: at most " + std::to_string(most_of_a_stranger));
  };
  check(urdf.links_.size(), "links");
  check(shapes, "pieces of collision geometry");
}

}  // namespace

RobotModel import_urdf(const std::string& xml, const std::string& origin,
                       const ImportOptions& options, ImportReport* report) {
  std::vector<std::string> warnings;
  const urdf::ModelInterfaceSharedPtr urdf = parse_urdf(xml, origin, &warnings);
  if (trust_in(options.folder) == Trust::stranger) check_size(*urdf, origin);
  ImportReport unread;
  ImportReport& told = report != nullptr ? *report : unread;
  RobotModel model = Importer(*urdf, origin, options, told).run();
  for (const std::string& warning : warnings) {
    told.quirks.push_back({"file", warning, "nothing that matters here"});
  }
  return model;
}

RobotModel import_urdf_file(const std::filesystem::path& file, ImportOptions options,
                            ImportReport* report) {
  std::error_code ignored;
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file, ignored)) {
    throw std::runtime_error(file.string() + ": cannot be opened");
  }
  const std::string xml{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  options.folder = file.parent_path();
  return import_urdf(xml, file.string(), options, report);
}

}  // namespace stagger::sim
