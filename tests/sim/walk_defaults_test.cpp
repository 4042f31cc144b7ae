#include "sim/robot/walk_defaults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace stagger::sim {
namespace {

using nlohmann::json;

/// Robot kasaei with another walk section; without one when `walk` is null.
std::shared_ptr<const Robot> kasaei_that_walks(const json& walk) {
  const auto folder =
      std::filesystem::path(::testing::TempDir()) / ("walk_defaults_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file("robots/kasaei/robot.urdf", folder / "robot.urdf",
                             std::filesystem::copy_options::overwrite_existing);
  json description = json::parse(std::ifstream("robots/kasaei/robot.json"));
  description.erase("walk");
  if (!walk.is_null()) description["walk"] = walk;
  std::ofstream(folder / "robot.json") << description.dump(2);
  auto robot = load_robot(folder);
  std::filesystem::remove_all(folder);
  return robot;
}

void expect_near(const WalkDescription& walk, const WalkDescription& wanted, double tolerance) {
  EXPECT_NEAR(walk.com_height_m, wanted.com_height_m, tolerance);
  EXPECT_NEAR(walk.stance_width_m, wanted.stance_width_m, tolerance);
  EXPECT_NEAR(walk.swing_height_m, wanted.swing_height_m, tolerance);
  EXPECT_NEAR(walk.t_ss_s, wanted.t_ss_s, tolerance);
  EXPECT_NEAR(walk.t_ds_s, wanted.t_ds_s, tolerance);
  EXPECT_NEAR(walk.t_init_s, wanted.t_init_s, tolerance);
  EXPECT_NEAR(walk.max_step_length_m, wanted.max_step_length_m, tolerance);
  EXPECT_NEAR(walk.max_step_back_m, wanted.max_step_back_m, tolerance);
  EXPECT_NEAR(walk.min_step_width_m, wanted.min_step_width_m, tolerance);
  EXPECT_NEAR(walk.max_step_width_m, wanted.max_step_width_m, tolerance);
}

constexpr BipedProportions human{0.9, 0.8, 0.67, 0.09, 0.2};

TEST(WalkDefaults, AreWhatTheReferenceRobotIsGiven) {
  const WalkDescription given = load_robot("robots/kasaei")->description.walk;
  expect_near(kasaei_that_walks({})->description.walk, given, 1e-6);
}

TEST(WalkDefaults, ScaleLengthsWithTheRobotAndTimesWithTheRootOfIt) {
  const WalkDescription large = walk_defaults(human);
  const WalkDescription small = walk_defaults({0.225, 0.2, 0.1675, 0.0225, 0.05});
  EXPECT_NEAR(small.t_ss_s, 0.5 * large.t_ss_s, 1e-12);
  EXPECT_NEAR(small.t_ds_s, 0.5 * large.t_ds_s, 1e-12);
  EXPECT_NEAR(small.t_init_s, 0.5 * large.t_init_s, 1e-12);
  EXPECT_NEAR(small.swing_height_m, 0.25 * large.swing_height_m, 1e-12);
  EXPECT_NEAR(small.max_step_length_m, 0.25 * large.max_step_length_m, 1e-12);
  EXPECT_NEAR(small.max_step_back_m, 0.25 * large.max_step_back_m, 1e-12);
  EXPECT_NEAR(small.min_step_width_m, 0.25 * large.min_step_width_m, 1e-12);
  EXPECT_NEAR(small.max_step_width_m, 0.25 * large.max_step_width_m, 1e-12);
}

TEST(WalkDefaults, TheLongestStepFitsStraightLegs) {
  BipedProportions p = human;
  p.hip_height = std::sqrt(0.99) * p.leg_length;
  // Two right triangles with the leg as hypotenuse and the hip's height as one side.
  EXPECT_NEAR(walk_defaults(p).max_step_length_m, 2.0 * 0.1 * p.leg_length, 1e-12);
  EXPECT_NEAR(walk_defaults(p).max_step_back_m, 2.0 * 0.1 * p.leg_length, 1e-12);
  p.hip_height = 0.5 * p.leg_length;
  EXPECT_NEAR(walk_defaults(p).max_step_length_m, 0.64 * p.leg_length, 1e-12);
  EXPECT_NEAR(walk_defaults(p).max_step_back_m, 0.42 * p.leg_length, 1e-12);
}

TEST(WalkDefaults, FeetThatStandTooCloseStepWider) {
  BipedProportions p = human;
  p.stance_width = 0.5 * p.sole_width;
  const WalkDescription walk = walk_defaults(p);
  EXPECT_DOUBLE_EQ(walk.stance_width_m, walk.min_step_width_m);
  EXPECT_GT(walk.min_step_width_m, p.sole_width);
}

TEST(WalkDefaults, GiveWayToTheDescriptionFieldByField) {
  const WalkDescription formula = kasaei_that_walks({})->description.walk;
  const WalkDescription walk =
      kasaei_that_walks({{"t_ss_s", 0.55}, {"swing_height_m", 0.03}})->description.walk;
  EXPECT_EQ(walk.t_ss_s, 0.55);
  EXPECT_EQ(walk.swing_height_m, 0.03);
  EXPECT_EQ(walk.t_ds_s, formula.t_ds_s);
  EXPECT_EQ(walk.max_step_width_m, formula.max_step_width_m);
}

TEST(WalkDefaults, FollowTheHeightThatTheDescriptionGives) {
  const WalkDescription walk = kasaei_that_walks({{"com_height_m", 0.81}})->description.walk;
  EXPECT_NEAR(walk.t_ss_s, 0.9 * 0.36, 1e-12);
  EXPECT_NEAR(walk.swing_height_m, 0.05, 1e-9);  // the legs are as long as before
}

TEST(WalkDefaults, WidthsThatDoNotFitTheFormulasOthersAreRefused) {
  try {
    kasaei_that_walks({{"max_step_width_m", 0.15}});
    FAIL() << "loaded";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/walk/max_step_width_m is 0.15 m; allowed: at "
                                                   "least stance_width_m (0.2 m)"));
  }
}

}  // namespace
}  // namespace stagger::sim
