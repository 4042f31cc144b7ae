#include "sim/robot/hip_flywheel.h"

#include <gtest/gtest.h>

namespace stagger::sim {
namespace {

TEST(HipFlywheel, HasHalfTheHipsTorqueAndSpeed) {
  const auto robot = load_robot("robots/kasaei");
  const engine::HipParameters hip = hip_flywheel(*robot);
  EXPECT_DOUBLE_EQ(hip.torque, 75.0);
  EXPECT_DOUBLE_EQ(hip.rate, 7.5);
}

TEST(HipFlywheel, TheLegsTurnAgainstTheTrunk) {
  // Less than the trunk alone about the hips, more than the trunk about its own centre.
  const auto robot = load_robot("robots/kasaei");
  const Body& trunk = robot->model.bodies[0];
  const double inertia = hip_flywheel(*robot).inertia;
  EXPECT_GT(inertia, trunk.inertia(1, 1));
  EXPECT_LT(inertia, trunk.inertia(1, 1) + trunk.mass * trunk.com.squaredNorm());
}

TEST(HipFlywheel, IsNoneWithoutARollingHip) {
  auto robot = std::make_shared<Robot>(*load_robot("robots/kasaei"));
  for (const char* joint : {"left_hip_roll", "left_ankle_roll"}) {
    const int i = robot->model.joint_index(joint);
    robot->model.bodies[static_cast<std::size_t>(i) + 1].axis = Vec3::UnitZ();
  }
  EXPECT_EQ(hip_flywheel(*robot).torque, 0.0);
}

}  // namespace
}  // namespace stagger::sim
