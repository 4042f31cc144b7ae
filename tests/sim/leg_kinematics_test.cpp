#include "sim/control/leg_kinematics.h"

#include <gtest/gtest.h>

#include "tests/sim/random_robot.h"

namespace stagger::sim {
namespace {

TEST(LegKinematics, AgreesWithTheWholeTree) {
  const auto robot = load_robot("robots/kasaei");
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const RobotState state = random.state(robot->model);
    const auto poses = body_poses(robot->model, state);
    for (const engine::Side side : {engine::Side::left, engine::Side::right}) {
      const Eigen::Isometry3d expected =
          poses[0].inverse() * poses[robot->foot_body(side)] * robot->sole_in_body(side);
      const Eigen::Isometry3d sole = LegKinematics(*robot, side).sole_in_base(state.q);
      EXPECT_LT((sole.matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace stagger::sim
