// Robots never seen before stand, step and take a push with what was found about them.
#include <gmock/gmock.h>

#include "found_biped.h"
#include "sim/experiment/trial.h"
#include "sim/simulation.h"

namespace stagger::sim {
namespace {

class FullBodyFoundRobot : public ::testing::TestWithParam<const char*> {
 protected:
  std::shared_ptr<const Robot> robot_ =
      written_robot(std::filesystem::path("tests/data/robots") / GetParam());
};

INSTANTIATE_TEST_SUITE_P(
    Robots, FullBodyFoundRobot,
    ::testing::Values("pitch_first.urdf", "backwards.urdf", "turned_frames.urdf",
                      "waist_and_arms.urdf"),
    [](const auto& instance) {
      return std::string(instance.param).substr(0, std::string(instance.param).find('.'));
    });

TEST_P(FullBodyFoundRobot, Stands) {
  SimulationConfig config;
  config.robot = robot_;
  Simulation simulation(config);
  for (int i = 0; i < 5000; ++i) simulation.step();
  EXPECT_EQ(simulation.fall_reason(), "");
  EXPECT_LT(simulation.frame().com.head<2>().norm(), 0.01);
  EXPECT_NEAR(simulation.frame().com.z(), robot_->description.walk.com_height_m, 0.01);
}

TEST_P(FullBodyFoundRobot, StepsInPlace) {
  SimulationConfig config;
  config.robot = robot_;
  Simulation simulation(config);
  simulation.walk({});
  for (int i = 0; i < 10000; ++i) simulation.step();
  EXPECT_EQ(simulation.fall_reason(), "");
  EXPECT_GT(simulation.frame().step_count, 10U);
  EXPECT_LT(simulation.frame().com.head<2>().norm(), 0.1);
}

/// A push of 0.08 in Froude's measure: it changes the velocity of the CoM by 0.08 sqrt(g h).
TEST_P(FullBodyFoundRobot, TakesAPushFromEverySide) {
  for (const double angle : {0.0, 0.5 * M_PI, M_PI, -0.5 * M_PI}) {
    TrialSpec spec;
    spec.settle_s = 2.0;
    spec.observe_s = 3.0;
    spec.push = PushSpec();
    spec.push->link = robot_->description.torso;
    spec.push->direction = {std::cos(angle), std::sin(angle), 0.0};
    spec.push->impulse_ns =
        0.08 * robot_->model.mass() * std::sqrt(9.81 * robot_->description.walk.com_height_m);
    spec.push->duration_s = 0.05;
    const TrialResult result = run_trial(spec, robot_);
    EXPECT_EQ(result.outcome, TrialOutcome::recovered) << angle << ": " << result.reason;
  }
}

}  // namespace
}  // namespace stagger::sim
