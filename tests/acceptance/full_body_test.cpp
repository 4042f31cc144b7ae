// Tier 3: the full body in Bullet under the engine. Pushes lie well below the measured limits.
#include <gtest/gtest.h>

#include <array>

#include "sim/experiment/trial.h"
#include "sim/simulation.h"
#include "tests/sim/kasaei.h"

namespace stagger::sim {
namespace {

struct Walked {
  bool fell;
  double worst_dcm_error;
  Vec3 com;
};

Walked walk(const engine::WalkCommand& command, double seconds) {
  SimulationConfig config;
  config.robot = kasaei();
  Simulation simulation(config);
  simulation.walk(command);
  for (int i = 0; i < std::lround(seconds / Simulation::tick_s); ++i) simulation.step();
  return {!simulation.fall_reason().empty(), simulation.worst_dcm_error(), simulation.frame().com};
}

TEST(FullBody, StepsInPlaceForAMinuteCloseToItsPlan) {
  const Walked result = walk({}, 60.0);
  EXPECT_FALSE(result.fell);
  EXPECT_LT(result.worst_dcm_error, 0.01);
  EXPECT_LT(result.com.head<2>().norm(), 0.1);
  EXPECT_NEAR(result.com.z(), 1.0, 0.02);
}

TEST(FullBody, WalksInEveryDirectionAtTheCommandedSpeed) {
  for (const Vec2& v : {Vec2(0.3, 0.0), Vec2(-0.3, 0.0), Vec2(0.0, 0.2), Vec2(0.0, -0.2)}) {
    const Walked result = walk({v.x(), v.y(), 0.0}, 20.0);
    EXPECT_FALSE(result.fell) << v.transpose();
    const Vec2 velocity = result.com.head<2>() / (20.0 - 1.0);  // less the start
    EXPECT_LT((velocity - v).norm(), 0.1 * v.norm()) << v.transpose();
  }
}

TEST(FullBody, TurnsMoreThanAWholeTurnBothWays) {
  for (const double wz : {0.4, -0.4}) {
    const Walked result = walk({0.0, 0.0, wz}, 20.0);
    EXPECT_FALSE(result.fell) << wz;
    EXPECT_LT(result.com.head<2>().norm(), 0.2) << wz;
  }
}

class FullBodyPushed : public ::testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Directions, FullBodyPushed, ::testing::Values(0, 90, 180, 270));

TEST_P(FullBodyPushed, RecoversAtEveryPartOfTheStep) {
  const double angle = GetParam() * M_PI / 180.0;
  for (int i = 0; i < 10; ++i) {
    TrialSpec spec;
    spec.robot = "kasaei";
    spec.push = PushSpec();
    spec.push->direction = {std::cos(angle), std::sin(angle), 0.0};
    spec.push->impulse_ns = 6.0;
    spec.push->duration_s = 0.05;
    spec.push->trigger = TimeTrigger{3.0 + 0.1 * i};  // two steps take a second
    const TrialResult result = run_trial(spec, kasaei());
    EXPECT_EQ(result.outcome, TrialOutcome::recovered)
        << GetParam() << " deg, " << i << ": " << result.reason;
    EXPECT_NEAR(result.delivered_ns, 6.0, 1e-9);
    EXPECT_GE(result.steps_to_recover.value_or(0), 1U) << GetParam() << " deg, " << i;
  }
}

/// A push of 10 ms in mid-step, left foot standing.
TrialSpec push_in_step(double direction_deg, double phase, double impulse_ns) {
  TrialSpec spec;
  spec.robot = "kasaei";
  spec.settle_s = 2.0;
  spec.push = PushSpec();
  const double angle = direction_deg * M_PI / 180.0;
  spec.push->direction = {std::cos(angle), std::sin(angle), 0.0};
  spec.push->impulse_ns = impulse_ns;
  spec.push->duration_s = 0.01;
  spec.push->trigger = PhaseTrigger{WalkingState::single_support, Side::left, phase};
  return spec;
}

class FullBodyStruck : public ::testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Directions, FullBodyStruck,
                         ::testing::Values(0, 45, 90, 135, 180, 225, 270, 315));

TEST_P(FullBodyStruck, SurvivesTwentyOneNewtonSecondsWithPerfectState) {
  for (const double phase : {0.1, 0.5}) {
    for (const double impulse : {9.0, 15.0, 21.0}) {
      TrialSpec spec = push_in_step(GetParam(), phase, impulse);
      spec.senses.perfect_state = true;
      EXPECT_EQ(run_trial(spec, kasaei()).outcome, TrialOutcome::recovered)
          << GetParam() << " deg at " << phase << ": " << impulse << " N s";
    }
  }
}

TEST_P(FullBodyStruck, SurvivesEighteenNewtonSecondsByItsSensors) {
  for (const double phase : {0.1, 0.35, 0.6, 0.85}) {
    EXPECT_EQ(run_trial(push_in_step(GetParam(), phase, 18.0), kasaei()).outcome,
              TrialOutcome::recovered)
        << GetParam() << " deg at " << phase;
  }
}

TEST(FullBodyStanding, TheHipsSaveWhatTheAnklesAloneCannot) {
  for (const double direction : {1.0, -1.0}) {
    TrialSpec spec;
    spec.robot = "kasaei";
    spec.stand = true;
    spec.settle_s = 1.0;
    spec.senses.perfect_state = true;
    spec.strategies = {.ankle = true, .hip = false, .step = false, .time = false};
    spec.push = PushSpec();
    spec.push->direction = {direction, 0.0, 0.0};
    spec.push->duration_s = 0.01;
    spec.push->impulse_ns = 4.5;
    EXPECT_EQ(run_trial(spec, kasaei()).outcome, TrialOutcome::recovered) << direction;
    spec.push->impulse_ns = 5.7;
    EXPECT_EQ(run_trial(spec, kasaei()).outcome, TrialOutcome::fell) << direction;
    spec.strategies.hip = true;
    EXPECT_EQ(run_trial(spec, kasaei()).outcome, TrialOutcome::recovered) << direction;
  }
}

TEST(FullBody, WalksFarByItsSensors) {
  // What nothing observes, place and heading, must not spoil what is observed.
  SimulationConfig config;
  config.robot = kasaei();
  Simulation simulation(config);
  simulation.walk({0.5, 0.0, 0.0});
  for (int i = 0; i < 220000; ++i) simulation.step();
  EXPECT_EQ(simulation.fall_reason(), "");
  EXPECT_GT(simulation.frame().com.head<2>().norm(), 100.0);
}

TEST(FullBody, StartsAndStopsTwentyTimes) {
  SimulationConfig config;
  config.robot = kasaei();
  Simulation simulation(config);
  const std::array<engine::WalkCommand, 4> commands{
      {{0.3, 0.0, 0.0}, {-0.2, 0.1, 0.0}, {0.1, 0.0, 0.2}, {0.3, 0.1, -0.2}}};
  for (int i = 0; i < 20; ++i) {
    simulation.walk(commands[static_cast<std::size_t>(i) % commands.size()]);
    // Stopped at another moment of the step each time.
    for (int tick = 0; tick < 2000 + 37 * i; ++tick) simulation.step();
    simulation.stop_walking();
    for (int tick = 0; tick < 3000; ++tick) simulation.step();
    ASSERT_EQ(simulation.fall_reason(), "") << i;
    ASSERT_EQ(simulation.frame().state, WalkingState::idle) << i;
  }
}

TEST(FullBody, StandsUpAgainAfterWalking) {
  SimulationConfig config;
  config.robot = kasaei();
  Simulation simulation(config);
  simulation.walk({0.2, 0.0, 0.0});
  for (int i = 0; i < 4000; ++i) simulation.step();
  simulation.stop_walking();
  for (int i = 0; i < 5000; ++i) simulation.step();
  const Frame& frame = simulation.frame();
  EXPECT_EQ(frame.state, WalkingState::idle);
  const Vec2 middle = 0.5 * (frame.feet[0].position + frame.feet[1].position).head<2>();
  EXPECT_LT((frame.com.head<2>() - middle).norm(), 0.01);
  EXPECT_LT(frame.com_velocity.norm(), 0.01);
}

TEST(FullBody, AnEarlierTrialLeavesNoTrace) {
  // Bullet repeats to the bit only in a fresh world: a trial must not depend on one before it.
  TrialSpec spec;
  spec.robot = "kasaei";
  spec.settle_s = 2.0;
  spec.observe_s = 1.0;
  spec.push = PushSpec();
  spec.push->impulse_ns = 5.0;
  const std::uint64_t first = run_trial(spec, kasaei()).state_hash;
  TrialSpec other = spec;
  other.push->impulse_ns = 40.0;
  run_trial(other, kasaei());
  EXPECT_EQ(run_trial(spec, kasaei()).state_hash, first);
}

}  // namespace
}  // namespace stagger::sim
