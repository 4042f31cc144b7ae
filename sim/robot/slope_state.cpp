#include "sim/robot/slope_state.h"

#include <Eigen/QR>
#include <algorithm>

#include "sim/robot/posture.h"
#include "sim/robot/rigid_body.h"

namespace stagger::sim {
namespace {

using engine::Side;

constexpr int most_slope_iterations = 50;
constexpr double close_enough = 1e-12;  // [m] and [rad]

Vec3 rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

}  // namespace

RobotState slope_state(const Robot& robot, const Vec3& normal) {
  RobotState state = walking_state(robot);
  RigidBody body(robot.model);
  body.update(state);
  const auto sole_now = [&](Side side) -> Eigen::Isometry3d {
    return body.pose(robot.foot_body(side)) * robot.sole_in_body(side);
  };
  engine::PerFoot<Eigen::Isometry3d> wanted;
  for (const Side side : {Side::left, Side::right}) {
    Eigen::Isometry3d& sole = wanted[engine::index(side)];
    sole = sole_now(side);
    sole.translation().z() = -normal.head<2>().dot(sole.translation().head<2>()) / normal.z();
    sole.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal) * sole.linear();
  }
  const Vec3 com = body.com();

  // Newton's method over the base's position and the joint angles; the trunk does not turn.
  const auto joints = static_cast<Eigen::Index>(robot.model.joint_count());
  Eigen::VectorXd error(15);
  Eigen::MatrixXd slope(15, 3 + joints);
  Matrix6X jacobian(6, 6 + joints);
  for (int i = 0; i < most_slope_iterations; ++i) {
    const auto fill = [&](Eigen::Index row, const auto& rows) {
      slope.block(row, 0, rows.rows(), 3) = rows.leftCols(3);
      slope.block(row, 3, rows.rows(), joints) = rows.rightCols(joints);
    };
    for (const Side side : {Side::left, Side::right}) {
      const Eigen::Isometry3d sole = sole_now(side);
      const Eigen::Isometry3d& goal = wanted[engine::index(side)];
      const Eigen::Index row = side == Side::left ? 0 : 6;
      error.segment<3>(row) = goal.translation() - sole.translation();
      error.segment<3>(row + 3) = rotation_vector(goal.linear() * sole.linear().transpose());
      body.jacobian(robot.foot_body(side), sole.translation(), jacobian);
      fill(row, jacobian);
    }
    error.tail<3>() = com - body.com();
    fill(12, body.com_jacobian());
    if (error.cwiseAbs().maxCoeff() < close_enough) break;
    const Eigen::VectorXd move = slope.completeOrthogonalDecomposition().solve(error);
    state.base_position += move.head<3>();
    for (Eigen::Index j = 0; j < joints; ++j) {
      const Body& moved = robot.model.bodies[static_cast<std::size_t>(j) + 1];
      state.q[j] = std::clamp(state.q[j] + move[3 + j], moved.lower, moved.upper);
    }
    body.update(state);
  }
  return state;
}

}  // namespace stagger::sim
