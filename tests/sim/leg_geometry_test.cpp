#include "sim/robot/leg_geometry.h"

#include <gtest/gtest.h>

#include "sim/robot/rigid_body.h"

namespace stagger::sim {
namespace {

using engine::Side;

TEST(LegGeometry, FindsHipKneeAndAnkleWhateverTheOrderOfTheJoints) {
  // kasaei's hips go yaw, roll, pitch, g1's pitch, roll, yaw.
  const auto kasaei = load_robot("robots/kasaei");
  const auto g1 = load_robot("robots/g1");
  for (const auto& [robot, hip, roll, ankle, length] :
       {std::tuple{kasaei, "left_thigh", "left_hip_roll_link", "left_ankle", 1.0},
        std::tuple{g1, "left_hip_pitch_link", "left_hip_roll_link", "left_ankle_pitch_link",
                   0.637}}) {
    const LegGeometry leg = leg_geometry(*robot, Side::left);
    EXPECT_EQ(robot->model.bodies.at(leg.hip_body).name, hip);
    EXPECT_EQ(robot->model.bodies.at(leg.hip_roll_body).name, roll);
    EXPECT_EQ(robot->model.bodies.at(leg.ankle_body).name, ankle);
    EXPECT_NEAR(leg.length, length, 0.002);
    ASSERT_EQ(leg.ankle_joints.size(), 2U);
    EXPECT_EQ(leg.ankle_joints[0], leg.ankle_body - 1);
    EXPECT_EQ(leg.ankle_joints[1], robot->foot_body(Side::left) - 1);
  }
}

TEST(LegGeometry, KnowsWhereTheKneeIsStraight) {
  for (const char* name : {"kasaei", "op3", "g1", "h1_2"}) {
    const auto robot = load_robot(std::string("robots/") + name);
    for (const Side side : {Side::left, Side::right}) {
      const LegGeometry leg = leg_geometry(*robot, side);
      RobotState state = nominal_state(*robot);
      const auto reach = [&](double knee) {
        state.q[leg.knee_joint] = knee;
        RigidBody body(robot->model);
        body.update(state);
        return (body.position(leg.hip_body) - body.position(leg.ankle_body)).norm();
      };
      const double bent = state.q[leg.knee_joint];
      EXPECT_GT(leg.knee_way * (bent - leg.straight_knee), 0.0) << name;
      EXPECT_LT(reach(bent), reach(leg.straight_knee)) << name;
      EXPECT_GT(reach(leg.straight_knee), reach(leg.straight_knee - 0.02)) << name;
      EXPECT_GT(reach(leg.straight_knee), reach(leg.straight_knee + 0.02)) << name;
    }
  }
}

TEST(LegGeometry, AStraightNominalPoseTellsNotWhichWayTheKneeBends) {
  auto robot = std::make_shared<Robot>(*load_robot("robots/kasaei"));
  robot->description.nominal_pose.clear();
  const LegGeometry leg = leg_geometry(*robot, Side::left);
  EXPECT_EQ(leg.knee_joint, -1);
  EXPECT_NEAR(leg.length, 1.0, 0.002);
}

TEST(LegGeometry, KnowsNothingOfALegWithoutThreeHinges) {
  auto robot = std::make_shared<Robot>(*load_robot("robots/kasaei"));
  const int knee = robot->model.joint_index("left_knee");
  robot->model.bodies[static_cast<std::size_t>(knee) + 1].axis = Vec3::UnitZ();
  const LegGeometry leg = leg_geometry(*robot, Side::left);
  EXPECT_EQ(leg.hip_body, -1);
  EXPECT_EQ(leg.length, 0.0);
}

}  // namespace
}  // namespace stagger::sim
