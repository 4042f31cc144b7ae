// From walking targets to joint torques: inverse dynamics as a quadratic program each tick.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/walking_targets.h"
#include "sim/control/qp.h"
#include "sim/robot/rigid_body.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

/// Weights and gains. First chosen by the push scores of a 30 kg biped on the same controller; the
/// push sweep in tests/bench measures them. Stiffness in 1/s^2, damping in 1/s.
struct WholeBodyGains {
  double com_weight = 1000.0;  ///< horizontal CoM acceleration w^2 (c - p)
  double height_weight = 100.0;
  double height_stiffness = 100.0;
  double height_damping = 20.0;
  double torso_weight = 1.0;  ///< low: the hips may lean to help the balance
  double torso_stiffness = 300.0;
  double torso_damping = 35.0;
  double swing_weight = 30.0;
  double swing_stiffness = 1500.0;
  double swing_damping = 75.0;
  double swing_acceleration_limit = 60.0;  ///< [m/s^2]
  double stance_weight = 1e4;
  double stance_damping = 60.0;
  double acceleration_regularisation = 1e-2;
  double force_regularisation = 1e-6;
  double friction = 0.5;  ///< of each axis of the pyramid; its corner (0.71) is below the plant's
  double sole_margin = 0.005;       ///< corners lie this far inside the sole [m]
  double least_normal_force = 0.5;  ///< per corner [N]
};

/// Decides accelerations and corner forces of the standing feet together, under the equations of
/// motion, friction pyramids and torque limits; the torques follow from both.
class WholeBodyController {
 public:
  explicit WholeBodyController(const Robot& robot, const WholeBodyGains& gains = {});

  /// Joint torques for this tick [N m]; `body` is up to date with the state.
  const Eigen::VectorXd& compute(const RigidBody& body, const RobotState& state,
                                 const engine::WalkingTargets& targets);

  /// Solves that failed so far; each was answered with damping alone.
  std::uint64_t failed_solves() const { return failed_solves_; }

 private:
  struct Foot {
    int body;
    Eigen::Isometry3d sole;       ///< sole frame in the body's frame
    std::array<Vec3, 4> corners;  ///< in the body's frame
  };
  struct Contact {
    int body;
    Vec3 point;  ///< world
  };
  using Rows = Eigen::Ref<const Eigen::MatrixXd>;

  /// Adds weight * |jacobian nudot - value|^2 to the cost.
  void add_task(double weight, const Rows& jacobian,
                const Eigen::Ref<const Eigen::VectorXd>& value);
  void add_com_task(const RigidBody& body, const engine::WalkingTargets& targets);
  void add_torso_task(const RigidBody& body, const engine::WalkingTargets& targets);
  void add_foot_task(const RigidBody& body, const Foot& foot, const engine::FootTarget& target,
                     const Eigen::Quaterniond& ground);
  void find_contacts(const RigidBody& body, const engine::WalkingTargets& targets);
  void add_dynamics(const RigidBody& body);
  void add_limits(const RigidBody& body, const RobotState& state);

  WholeBodyGains gains_;
  double gravity_ = 9.81;
  std::vector<Body> joints_;  ///< whose motors limit the torques, in joint order
  engine::PerFoot<Foot> feet_;
  int torso_body_;
  Eigen::Matrix3d torso_in_body_;
  Eigen::Index nv_;
  std::vector<Contact> contacts_;
  Matrix6X jacobian_;
  Eigen::MatrixXd contact_jacobian_;  ///< three rows a corner
  QpProblem problem_;
  QpSolver solver_;
  Eigen::VectorXd torque_;
  std::uint64_t failed_solves_ = 0;
};

}  // namespace stagger::sim
