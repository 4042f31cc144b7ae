// Tier 3: the full body stands, is pushed, steps, and stands again. Nobody tells it to walk.
#include <gtest/gtest.h>

#include "sim/simulation.h"
#include "tests/sim/kasaei.h"

namespace stagger::sim {
namespace {

struct Recovered {
  std::string fall_reason;
  WalkingState state;
  bool stepped_at_once;
  std::uint64_t steps;
  double off_the_middle;
  Vec2 apart;  ///< left foot from the right one, in the feet's own frame
};

/// A push at the torso that changes the CoM's velocity by `speed` m/s in all.
Recovered push(double direction_deg, double speed, double duration,
               const engine::Strategies& strategies = {}) {
  SimulationConfig config;
  config.robot = kasaei();
  config.strategies = strategies;
  Simulation simulation(config);
  for (int i = 0; i < 200; ++i) simulation.step();
  PushSpec spec;
  const double angle = direction_deg * M_PI / 180.0;
  spec.direction = {std::cos(angle), std::sin(angle), 0.0};
  spec.impulse_ns = kasaei()->model.mass() * speed;
  spec.duration_s = duration;
  simulation.push(spec);
  Recovered result{};
  for (int i = 0; i < 5000 && simulation.fall_reason().empty(); ++i) {
    const Frame& frame = simulation.step();
    if (i * Simulation::tick_s < duration + 0.01 && frame.recovering) result.stepped_at_once = true;
  }
  const Frame& frame = simulation.frame();
  const Vec2 left = frame.feet[0].position.head<2>();
  const Vec2 right = frame.feet[1].position.head<2>();
  result.fall_reason = simulation.fall_reason();
  result.state = frame.state;
  result.steps = frame.step_count;
  result.off_the_middle = (frame.com.head<2>() - 0.5 * (left + right)).norm();
  result.apart = engine::rotated(left - right, -0.5 * (frame.feet[0].yaw + frame.feet[1].yaw));
  return result;
}

class FullBodyRecovery : public ::testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Directions, FullBodyRecovery, ::testing::Range(0, 360, 45));

TEST_P(FullBodyRecovery, StepsAndStandsAgain) {
  for (const double duration : {0.01, 0.1}) {
    for (const double speed : {0.45, 0.55}) {
      const Recovered result = push(GetParam(), speed, duration);
      EXPECT_EQ(result.fall_reason, "") << speed << " m/s in " << duration << " s";
      EXPECT_EQ(result.state, WalkingState::idle) << speed << " m/s in " << duration << " s";
      EXPECT_LT(result.off_the_middle, 0.015) << speed << " m/s in " << duration << " s";
      EXPECT_LT((result.apart - Vec2(0.0, 0.2)).norm(), 0.04)
          << speed << " m/s in " << duration << " s";
      EXPECT_TRUE(result.stepped_at_once) << speed << " m/s in " << duration << " s";
      EXPECT_GE(result.steps, 2U);
    }
  }
}

TEST(FullBodyRecovery, WhatTheAnkleHoldsNeedsNoStep) {
  EXPECT_EQ(push(0.0, 0.12, 0.01).steps, 0U);
  EXPECT_EQ(push(90.0, 0.2, 0.1).steps, 0U);
}

TEST(FullBodyRecovery, WithoutStepsItFalls) {
  EXPECT_NE(push(0.0, 0.4, 0.01, {.step = false}).fall_reason, "");
}

}  // namespace
}  // namespace stagger::sim
