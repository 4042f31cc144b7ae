#include "sim/experiment/trial.h"

#include <gtest/gtest.h>

namespace stagger::sim {
namespace {

class TrialTest : public ::testing::Test {
 protected:
  TrialSpec spec_with(double impulse) {
    TrialSpec spec;
    spec.robot = "kasaei";
    spec.plant = PlantKind::lipm;
    PushSpec push;
    push.impulse_ns = impulse;
    push.duration_s = 0.05;
    spec.push = push;
    return spec;
  }
  std::shared_ptr<const Robot> robot = load_robot("robots/kasaei");
};

TEST_F(TrialTest, RecoversFromAModeratePush) {
  const TrialResult result = run_trial(spec_with(6.0), robot);
  EXPECT_EQ(result.outcome, TrialOutcome::recovered);
  EXPECT_NEAR(result.delivered_ns, 6.0, 1e-9);
  EXPECT_EQ(result.push_tick, 3000U);
  EXPECT_GE(result.steps_to_recover.value(), 1U);
  EXPECT_FALSE(result.fall_time_s);
  EXPECT_EQ(result.ticks, 3000U + 50U + 4000U);
}

TEST_F(TrialTest, NeedsNoStepForATouch) {
  const TrialResult result = run_trial(spec_with(0.05), robot);
  EXPECT_EQ(result.outcome, TrialOutcome::recovered);
  EXPECT_EQ(result.steps_to_recover, 0U);
}

TEST_F(TrialTest, FallsAndSaysWhen) {
  const TrialResult result = run_trial(spec_with(150.0), robot);
  EXPECT_EQ(result.outcome, TrialOutcome::fell);
  EXPECT_GT(result.fall_time_s.value(), 3.0);
  EXPECT_FALSE(result.reason.empty());
  EXPECT_FALSE(result.steps_to_recover);
}

TEST_F(TrialTest, WithoutStepsALesserPushIsTooMuch) {
  TrialSpec spec = spec_with(10.0);
  EXPECT_EQ(run_trial(spec, robot).outcome, TrialOutcome::recovered);
  spec.strategies.step = false;
  EXPECT_EQ(run_trial(spec, robot).outcome, TrialOutcome::fell);
}

TEST_F(TrialTest, PushesAtTheGaitPhase) {
  TrialSpec spec = spec_with(3.0);
  spec.push->trigger = PhaseTrigger{engine::WalkingState::single_support, Side::right, 0.5};
  const TrialResult result = run_trial(spec, robot);
  EXPECT_EQ(result.outcome, TrialOutcome::recovered);
  EXPECT_GT(result.push_tick.value(), 3000U);
}

TEST_F(TrialTest, TimesOutWhenThePhaseNeverComes) {
  TrialSpec spec = spec_with(3.0);
  spec.push->trigger = PhaseTrigger{engine::WalkingState::idle, {}, 0.5};
  EXPECT_EQ(run_trial(spec, robot).outcome, TrialOutcome::timeout);
}

TEST_F(TrialTest, WithoutAPushItOnlyObserves) {
  TrialSpec spec = spec_with(1.0);
  spec.push.reset();
  const TrialResult result = run_trial(spec, robot);
  EXPECT_EQ(result.outcome, TrialOutcome::recovered);
  EXPECT_EQ(result.delivered_ns, 0.0);
  EXPECT_FALSE(result.push_tick);
}

TEST_F(TrialTest, TellsWhenItWasBack) {
  EXPECT_EQ(run_trial(spec_with(0.05), robot).recovery_time_s, 0.0);
  const TrialResult result = run_trial(spec_with(15.0), robot);
  EXPECT_GT(result.recovery_time_s.value(), 0.1);  // a step at least
  EXPECT_LT(result.recovery_time_s.value(), 3.0);
  EXPECT_FALSE(run_trial(spec_with(150.0), robot).recovery_time_s);
  TrialSpec brief = spec_with(15.0);
  brief.observe_s = 0.1;
  const TrialResult unfinished = run_trial(brief, robot);
  EXPECT_EQ(unfinished.outcome, TrialOutcome::recovered);
  EXPECT_FALSE(unfinished.recovery_time_s);
}

TEST_F(TrialTest, StandsWhenItIsToStand) {
  TrialSpec spec = spec_with(3.0);
  spec.stand = true;
  const TrialResult result = run_trial(spec, robot);
  EXPECT_EQ(result.outcome, TrialOutcome::recovered);
  EXPECT_EQ(result.steps_to_recover, 0U);
  EXPECT_TRUE(result.recovery_time_s);
  spec.push->impulse_ns = 200.0;
  EXPECT_EQ(run_trial(spec, robot).outcome, TrialOutcome::fell);
  // No phase of a gait ever comes.
  spec.push->trigger = PhaseTrigger{engine::WalkingState::single_support, {}, 0.5};
  EXPECT_EQ(run_trial(spec, robot).outcome, TrialOutcome::timeout);
}

TEST_F(TrialTest, RepeatsToTheBit) {
  EXPECT_EQ(run_trial(spec_with(6.0), robot).state_hash,
            run_trial(spec_with(6.0), robot).state_hash);
  EXPECT_NE(run_trial(spec_with(6.0), robot).state_hash,
            run_trial(spec_with(6.1), robot).state_hash);
}

}  // namespace
}  // namespace stagger::sim
