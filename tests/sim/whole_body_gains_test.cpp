#include "sim/control/whole_body_gains.h"

#include <gtest/gtest.h>

#include "sim/robot/hip_flywheel.h"

namespace stagger::sim {
namespace {

/// Robot kasaei as if its CoM were elsewhere.
WholeBodyGains gains_at(double com_height) {
  Robot robot = *load_robot("robots/kasaei");
  robot.description.walk.com_height_m = com_height;
  return whole_body_gains(robot);
}

TEST(WholeBodyGainsTest, AreTheDefaultsForTheReferenceRobot) {
  const WholeBodyGains gains = gains_at(1.0);
  const WholeBodyGains defaults;
  EXPECT_DOUBLE_EQ(gains.com_weight, defaults.com_weight);
  EXPECT_DOUBLE_EQ(gains.height_stiffness, defaults.height_stiffness);
  EXPECT_NEAR(gains.torso_weight, defaults.torso_weight, 1e-3 * defaults.torso_weight);
  EXPECT_DOUBLE_EQ(gains.torso_damping, defaults.torso_damping);
  EXPECT_DOUBLE_EQ(gains.swing_stiffness, defaults.swing_stiffness);
  EXPECT_DOUBLE_EQ(gains.swing_turn_stiffness, defaults.swing_turn_stiffness);
  EXPECT_DOUBLE_EQ(gains.swing_turn_damping, defaults.swing_turn_damping);
  EXPECT_DOUBLE_EQ(gains.stance_damping, defaults.stance_damping);
  EXPECT_DOUBLE_EQ(gains.acceleration_regularisation, defaults.acceleration_regularisation);
  EXPECT_DOUBLE_EQ(gains.force_regularisation, defaults.force_regularisation);
  EXPECT_DOUBLE_EQ(gains.sole_margin, defaults.sole_margin);
  EXPECT_DOUBLE_EQ(gains.least_normal_force, defaults.least_normal_force);
  EXPECT_DOUBLE_EQ(gains.fallback_damping, defaults.fallback_damping);
}

TEST(WholeBodyGainsTest, OfAQuarterOfTheHeightAreTwiceAsQuick) {
  const WholeBodyGains gains = gains_at(0.25);
  const WholeBodyGains defaults;
  EXPECT_NEAR(gains.swing_stiffness, 4.0 * defaults.swing_stiffness, 1e-9);
  EXPECT_NEAR(gains.swing_damping, 2.0 * defaults.swing_damping, 1e-9);
  EXPECT_NEAR(gains.height_stiffness, 4.0 * defaults.height_stiffness, 1e-9);
  EXPECT_NEAR(gains.stance_damping, 2.0 * defaults.stance_damping, 1e-9);
  // An acceleration is a share of gravity, whatever the size.
  EXPECT_EQ(gains.swing_acceleration_limit, defaults.swing_acceleration_limit);
  EXPECT_EQ(gains.com_weight, defaults.com_weight);
  EXPECT_EQ(gains.swing_turn_acceleration_limit, 4.0 * defaults.swing_turn_acceleration_limit);
  // At 1/4 of the size the same angular acceleration is 1/4 of the linear one.
  EXPECT_NEAR(gains.limit_weight, defaults.limit_weight / 16.0, 1e-12);
  EXPECT_NEAR(gains.angular_length, 0.25, 1e-12);
  EXPECT_NEAR(gains.sole_margin, 0.25 * defaults.sole_margin, 1e-12);
  // Torque (1/4) by angular velocity (2).
  EXPECT_NEAR(gains.fallback_damping, defaults.fallback_damping / 8.0, 1e-12);
}

TEST(WholeBodyGainsTest, ATorsoCountsWithItsRadiusOfGyration) {
  Robot robot = *load_robot("robots/kasaei");
  const double before = whole_body_gains(robot).torso_weight;
  for (Body& body : robot.model.bodies) body.mass *= 2.0, body.inertia *= 2.0;
  EXPECT_NEAR(whole_body_gains(robot).torso_weight, before, 1e-9 * before);

  // The legs go against the trunk as before.
  const double leaning = lean_inertia(robot);
  robot.model.bodies[0].inertia += 0.5 * leaning * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(whole_body_gains(robot).torso_weight, 1.5 * before, 1e-9 * before);
}

TEST(WholeBodyGainsTest, ASwingFootIsHeldAsStifflyAsTheDelayAllows) {
  const auto kasaei = load_robot("robots/kasaei");
  const WholeBodyGains quick = whole_body_gains(*kasaei, 0.001);
  const WholeBodyGains late = whole_body_gains(*kasaei, 0.004);
  EXPECT_NEAR(quick.swing_turn_stiffness, 16.0 * late.swing_turn_stiffness, 1e-6);
  EXPECT_NEAR(quick.swing_turn_damping, 4.0 * late.swing_turn_damping, 1e-6);
  // Never less than its place is.
  EXPECT_DOUBLE_EQ(whole_body_gains(*kasaei, 0.1).swing_turn_stiffness, late.swing_stiffness);
}

TEST(WholeBodyGainsTest, ForcesFollowTheWeight) {
  const auto op3 = load_robot("robots/op3");
  const WholeBodyGains gains = whole_body_gains(*op3);
  const double share = op3->model.mass() / 30.0;
  EXPECT_NEAR(gains.least_normal_force, 0.5 * share, 1e-12);
  EXPECT_NEAR(gains.force_regularisation * share * share, 1e-6, 1e-12);
}

}  // namespace
}  // namespace stagger::sim
