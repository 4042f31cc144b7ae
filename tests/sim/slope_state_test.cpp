#include "sim/robot/slope_state.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/robot/rigid_body.h"

namespace stagger::sim {
namespace {

TEST(SlopeStateTest, SolesLieOnThePlaneUnderAnUprightTrunk) {
  const auto robot = load_robot("robots/kasaei");
  const RobotState nominal = nominal_state(*robot);
  RigidBody body(robot->model);
  body.update(nominal);
  const Vec3 com = body.com();
  for (const Vec3& steep : {Vec3(-0.14, 0.0, 1.0), Vec3(0.14, 0.0, 1.0), Vec3(0.1, 0.1, 1.0)}) {
    const Vec3 normal = steep.normalized();
    const RobotState state = slope_state(*robot, normal);
    body.update(state);
    EXPECT_NEAR((body.com() - com).norm(), 0.0, 1e-9);
    EXPECT_EQ(state.base_orientation.coeffs(), nominal.base_orientation.coeffs());
    const auto nominal_poses = body_poses(robot->model, nominal);
    for (const engine::Side side : {engine::Side::left, engine::Side::right}) {
      const int foot = robot->foot_body(side);
      const Eigen::Isometry3d sole = body.pose(foot) * robot->sole_in_body(side);
      const Eigen::Isometry3d before = nominal_poses[foot] * robot->sole_in_body(side);
      EXPECT_NEAR(sole.translation().dot(normal), 0.0, 1e-9);
      EXPECT_NEAR((sole.linear().col(2) - normal).norm(), 0.0, 1e-9);
      EXPECT_NEAR((sole.translation() - before.translation()).head<2>().norm(), 0.0, 1e-9);
    }
  }
}

TEST(SlopeStateTest, OnLevelGroundItIsTheNominalState) {
  const auto robot = load_robot("robots/kasaei");
  const RobotState state = slope_state(*robot, Vec3::UnitZ());
  EXPECT_NEAR((state.q - nominal_state(*robot).q).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace stagger::sim
