// From walking targets to joint torques: inverse dynamics as a quadratic program each tick.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/walking_targets.h"
#include "sim/control/qp.h"
#include "sim/control/whole_body_gains.h"
#include "sim/robot/leg_geometry.h"
#include "sim/robot/rigid_body.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

/// Decides accelerations and corner forces of the standing feet together, under the equations of
/// motion, friction pyramids and torque limits; the torques follow from both.
class WholeBodyController {
 public:
  explicit WholeBodyController(const Robot& robot)
      : WholeBodyController(robot, whole_body_gains(robot)) {}
  WholeBodyController(const Robot& robot, const WholeBodyGains& gains);

  /// Other weights and gains from the next tick on; sole_margin stays.
  void set_gains(const WholeBodyGains& gains);

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

  /// Adds weight * |jacobian nudot - value|^2 / 2 to the cost.
  void add_task(double weight, const Rows& jacobian,
                const Eigen::Ref<const Eigen::VectorXd>& value);
  void add_com_task(const RigidBody& body, const engine::WalkingTargets& targets);
  /// Height of the CoM that lets both legs reach where they stand and where they will land [m].
  double reachable_com_height(const RigidBody& body, const engine::WalkingTargets& targets) const;
  /// Slows a joint down in time before the end of its range. A task, not a constraint: at the end
  /// of a range torque limits and contact can leave no solution at all.
  void add_joint_limit_tasks(const RobotState& state);
  void add_momentum_task(const RigidBody& body, const engine::WalkingTargets& targets);
  void add_torso_task(const RigidBody& body, const engine::WalkingTargets& targets);
  /// How far the ankle is from the ends of its ranges: 1 well inside, next to nothing at an end,
  /// unless `turn`, a rotation vector, takes the foot away from there. By the foot's jacobian_.
  double ankle_freedom(const LegGeometry& leg, const RobotState& state, const Vec3& turn) const;
  /// At the end of its ankle's range a foot tilts: held level it would drag the whole body along.
  void add_foot_task(const RigidBody& body, const Foot& foot, const engine::FootTarget& target,
                     const LegGeometry& leg, const RobotState& state,
                     const Eigen::Quaterniond& ground);
  /// The cost of the tasks that were added.
  void sum_up_tasks();
  void find_contacts(const RigidBody& body, const engine::WalkingTargets& targets);
  void add_dynamics(const RigidBody& body);
  void add_limits(const RigidBody& body, const RobotState& state);

  WholeBodyGains gains_;
  double gravity_ = 9.81;
  std::vector<Body> joints_;  ///< whose motors limit the torques, in joint order
  engine::PerFoot<Foot> feet_;
  engine::PerFoot<LegGeometry> legs_;
  std::vector<double> limit_weights_;  ///< of each joint
  int torso_body_;
  Eigen::Matrix3d torso_in_body_;
  Eigen::Index nv_;
  std::vector<Contact> contacts_;
  Matrix6X jacobian_;
  Eigen::MatrixXd contact_jacobian_;  ///< three rows a corner
  Eigen::MatrixXd task_rows_;         ///< Jacobians of the tasks, each times the root of its weight
  Eigen::VectorXd task_values_;
  Eigen::Index task_count_ = 0;  ///< rows in use
  QpProblem problem_;
  QpSolver solver_;
  Eigen::VectorXd torque_;
  std::uint64_t failed_solves_ = 0;
};

}  // namespace stagger::sim
