#include "sim/robot/posture.h"

#include <gtest/gtest.h>

#include "sim/robot/legs.h"

namespace stagger::sim {
namespace {

using engine::Side;

double com_height(const RigidBody& body) { return body.com().z(); }

class PostureTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::shared_ptr<const Robot> robot = load_robot(std::string("robots/") + GetParam());
};

INSTANTIATE_TEST_SUITE_P(Robots, PostureTest, ::testing::Values("kasaei", "op3", "g1", "h1_2"));

TEST_P(PostureTest, LowersTheBodyStraightDownOnFlatSoles) {
  RigidBody nominal(robot->model);
  nominal.update(nominal_state(*robot));
  const double height = 0.9 * nominal.com().z();
  const RobotState state = lowered_state(*robot, com_height, height);
  RigidBody body(robot->model);
  body.update(state);
  EXPECT_NEAR(body.com().z(), height, 1e-6);
  EXPECT_NEAR(body.com().x(), nominal.com().x(), 1e-6);
  EXPECT_NEAR(body.com().y(), nominal.com().y(), 1e-6);
  EXPECT_LT(state.base_orientation.angularDistance(nominal_state(*robot).base_orientation), 1e-6);
  for (const Side side : {Side::left, Side::right}) {
    EXPECT_LT((sole_centre(body, *robot, side) - sole_centre(nominal, *robot, side)).norm(), 1e-6);
    const int foot = robot->foot_body(side);
    EXPECT_LT((body.rotation(foot) - nominal.rotation(foot)).norm(), 1e-6);
  }
}

TEST_P(PostureTest, StaysInTheNominalPoseWhenThatIsLowEnough) {
  const RobotState state = lowered_state(*robot, com_height, 2.0);
  EXPECT_EQ(state.q, nominal_state(*robot).q);
}

TEST_P(PostureTest, StaysInTheNominalPoseWhenItCannotGoThatLow) {
  const RobotState state = lowered_state(*robot, com_height, 0.05);
  EXPECT_EQ(state.q, nominal_state(*robot).q);
}

TEST_P(PostureTest, WalksWithBentKnees) {
  RigidBody body(robot->model);
  body.update(walking_state(*robot));
  EXPECT_NEAR(body.com().z(), robot->description.walk.com_height_m, 1e-6);
  EXPECT_NEAR(hip_height(body, *robot) / leg_length(body, *robot), 0.84, 1e-4);
}

}  // namespace
}  // namespace stagger::sim
