#include "sim/robot/hip_flywheel.h"

#include <Eigen/QR>
#include <algorithm>

#include "sim/robot/leg_geometry.h"
#include "sim/robot/rigid_body.h"

namespace stagger::sim {
namespace {

/// The part of the hips' torque and speed that the hip strategy may reckon with: the rest holds the
/// body up and moves the legs.
constexpr double hip_torque_share = 0.5;
constexpr double hip_speed_share = 0.5;
constexpr double hip_angle = 0.5;  // [rad]

}  // namespace

double lean_inertia(const Robot& robot) {
  RigidBody body(robot.model);
  body.update(nominal_state(robot));
  Eigen::MatrixXd held(18, body.nv());
  Matrix6X jacobian(6, body.nv());
  for (const engine::Side side : {engine::Side::left, engine::Side::right}) {
    const int foot = robot.foot_body(side);
    body.jacobian(foot, body.position(foot), jacobian);
    held.middleRows<6>(6 * static_cast<Eigen::Index>(engine::index(side))) = jacobian;
  }
  held.middleRows<3>(12) = body.com_jacobian();
  body.jacobian(0, body.position(0), jacobian);
  held.bottomRows<3>() = jacobian.bottomRows<3>();
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> motion(held);
  engine::Vec2 inertia;
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    const Eigen::VectorXd nu = motion.solve(Eigen::VectorXd::Unit(18, 15 + axis));
    inertia[axis] = body.angular_momentum_matrix().row(axis).dot(nu);
  }
  return inertia.minCoeff();
}

engine::HipParameters hip_flywheel(const Robot& robot) {
  engine::HipParameters hip;
  const LegGeometry leg = leg_geometry(robot, engine::Side::left);
  const double inertia = lean_inertia(robot);
  if (leg.hip_body < 0 || leg.hip_roll_body < 0 || !(inertia > 0.0)) return hip;
  const Body& pitch = robot.model.bodies[static_cast<std::size_t>(leg.hip_body)];
  const Body& roll = robot.model.bodies[static_cast<std::size_t>(leg.hip_roll_body)];
  hip.inertia = inertia;
  hip.torque = hip_torque_share * std::min(pitch.effort, roll.effort);
  hip.rate = hip_speed_share * std::min(pitch.velocity, roll.velocity);
  hip.angle = hip_angle;
  return hip;
}

}  // namespace stagger::sim
