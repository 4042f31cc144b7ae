// A robot as mathematics sees it: rigid bodies in a tree of revolute joints on a floating base.
// Neither urdfdom nor Bullet is known here.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/types.h"

namespace stagger::sim {

using engine::Vec3;

/// One convex piece of a body's collision geometry.
struct Shape {
  enum class Kind : std::uint8_t { box, cylinder, sphere, hull };
  Kind kind = Kind::box;
  /// box: full edges; cylinder: (radius, length along z, unused); sphere: (radius, ...);
  /// hull: edges of the box around it [m]
  Vec3 size = Vec3::Zero();
  std::vector<Vec3> points = {};  ///< hull: the points whose convex hull it is, in its frame [m]
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the body's frame
};

/// A rigid body: one link, or several that fixed joints hold together. Its frame is the frame of
/// its first link, which is where its joint is.
struct Body {
  std::string name;   ///< of its first link
  int parent = -1;    ///< index of the parent body, always less than its own; -1 for the base
  std::string joint;  ///< the revolute joint that carries it; empty for the base
  /// The joint's frame in the parent body's frame; the body's frame coincides with it at q = 0.
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
  Vec3 axis = Vec3::UnitZ();  ///< of the joint, unit, in the body's frame
  double lower = 0.0;         ///< [rad]; -infinity when unlimited
  double upper = 0.0;         ///< [rad]; +infinity when unlimited
  double effort = 0.0;        ///< greatest |torque| [N m]; +infinity when unlimited
  double velocity = 0.0;      ///< greatest |joint velocity| [rad/s]; +infinity when unlimited
  double mass = 0.0;          ///< [kg], > 0
  Vec3 com = Vec3::Zero();    ///< centre of mass in the body's frame [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about com, body axes [kg m^2]
  std::vector<Shape> shapes;
};

/// Where a URDF link sits in its body, and what it weighs on its own.
struct LinkPlace {
  int body = 0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< link frame in the body's frame
  Vec3 com = Vec3::Zero();  ///< in the LINK's frame [m]; its origin when the link has no mass
  double mass = 0.0;        ///< [kg]
};

struct RobotModel {
  std::string name;
  std::vector<Body> bodies;                ///< parents before children; [0] is the floating base
  std::map<std::string, LinkPlace> links;  ///< every link of the URDF

  double mass() const;  ///< of the whole robot [kg]
  /// Joint i carries bodies[i + 1].
  std::size_t joint_count() const { return bodies.empty() ? 0 : bodies.size() - 1; }
  std::vector<std::string> joint_names() const;
  /// Index of the joint of that name; -1 when there is none.
  int joint_index(const std::string& joint) const;
};

/// Where every body is and how it moves.
struct RobotState {
  Vec3 base_position = Vec3::Zero();  ///< origin of the base body's frame, world [m]
  Eigen::Quaterniond base_orientation = Eigen::Quaterniond::Identity();
  Vec3 base_velocity = Vec3::Zero();          ///< of the base body's origin, world axes [m/s]
  Vec3 base_angular_velocity = Vec3::Zero();  ///< world axes [rad/s]
  Eigen::VectorXd q;                          ///< joint angles [rad]
  Eigen::VectorXd qd;                         ///< joint velocities [rad/s]
};

/// World pose of every body, in the order of model.bodies. For set-up and tests; a control loop
/// uses RigidBody.
std::vector<Eigen::Isometry3d> body_poses(const RobotModel& model, const RobotState& state);

}  // namespace stagger::sim
