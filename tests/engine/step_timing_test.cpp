#include "engine/step_timing.h"

#include <gtest/gtest.h>

namespace stagger::engine {
namespace {

TEST(StepTiming, ComfortableStepsKeepTheNominalTimes) {
  const Parameters p;
  for (const WalkCommand& command :
       {WalkCommand{}, WalkCommand{0.5, 0.0, 0.0}, WalkCommand{-0.5, 0.0, 0.0},
        WalkCommand{0.0, 0.11, 0.0}, WalkCommand{0.0, 0.0, -0.35}}) {
    EXPECT_EQ(step_times(command, p).t_ss, p.t_ss) << command.vx << command.vy << command.wz;
    EXPECT_EQ(step_times(command, p).t_ds, p.t_ds);
  }
}

TEST(StepTiming, FasterWalksTakeQuickerStepsOfTheComfortableSize) {
  const Parameters p;
  for (const double sign : {1.0, -1.0}) {
    EXPECT_NEAR(step_times({sign * 0.8, 0.0, 0.0}, p).step(), 0.6 * 0.95 / 0.8, 1e-12);
    EXPECT_NEAR(step_times({0.0, sign * 0.2, 0.0}, p).step(), 0.6 * 0.4 / 0.4, 1e-12);
    EXPECT_NEAR(step_times({0.0, 0.0, sign * 0.5}, p).step(), 0.6 * 0.6 / 0.5, 1e-12);
  }
}

TEST(StepTiming, TheMostDemandingPartDecides) {
  const Parameters p;
  const double sideways = step_times({0.0, 0.2, 0.0}, p).t_ss;
  EXPECT_EQ(step_times({0.3, 0.2, 0.2}, p).t_ss, sideways);
  EXPECT_EQ(step_times({-0.3, -0.2, 0.2}, p).t_ss, sideways);
  EXPECT_LT(step_times({1.5, 0.2, 0.2}, p).t_ss, sideways);
}

TEST(StepTiming, NeverQuickerThanTheLeastSwing) {
  Parameters p;
  EXPECT_EQ(step_times({9.0, 9.0, 9.0}, p).t_ss, p.least_t_ss);
  p.max_step_width = p.stance_width;
  EXPECT_EQ(step_times({0.0, 0.1, 0.0}, p).t_ss, p.least_t_ss);
  EXPECT_EQ(step_times({0.3, 0.0, 0.0}, p).t_ss, p.t_ss);
}

TEST(StepTiming, DoubleSupportMayLastNoTime) {
  Parameters p;
  p.t_ss = 0.8;
  p.t_ds = 0.0;
  EXPECT_EQ(step_times({0.5, 0.0, 0.0}, p).t_ds, 0.0);
  EXPECT_NEAR(step_times({1.0, 0.0, 0.0}, p).t_ss, 0.57, 1e-12);
  EXPECT_NEAR(step_times({0.0, 0.25, 0.0}, p).t_ss, 0.48, 1e-12);
}

}  // namespace
}  // namespace stagger::engine
