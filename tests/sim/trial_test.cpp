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

TEST_F(TrialTest, AListOfOneIsThePush) {
  for (const double impulse : {6.0, 15.0, 150.0}) {
    const TrialSpec one = spec_with(impulse);
    TrialSpec list = one;
    list.push.reset();
    list.pushes = {*one.push};
    const TrialResult expected = run_trial(one, robot);
    const TrialResult result = run_trial(list, robot);
    EXPECT_EQ(result.state_hash, expected.state_hash);
    EXPECT_EQ(result.ticks, expected.ticks);
    EXPECT_EQ(result.outcome, expected.outcome);
    EXPECT_EQ(result.steps_to_recover, expected.steps_to_recover);
    EXPECT_EQ(result.recovery_time_s, expected.recovery_time_s);
    EXPECT_EQ(result.delivered_ns, expected.delivered_ns);
    EXPECT_EQ(result.push_tick, expected.push_tick);
    EXPECT_TRUE(expected.pushes.empty());
    ASSERT_EQ(result.pushes.size(), 1U);
    EXPECT_EQ(result.pushes[0].start_tick, expected.push_tick);
    EXPECT_EQ(result.pushes[0].steps_to_recover, expected.steps_to_recover);
    EXPECT_EQ(result.pushes[0].recovery_time_s, expected.recovery_time_s);
    EXPECT_EQ(result.pushes[0].fell, expected.outcome == TrialOutcome::fell);
  }
}

TEST_F(TrialTest, PushesOfAListComeOneAfterAnotherAndEachHasItsResult) {
  TrialSpec spec = spec_with(6.0);
  PushSpec push = *spec.push;
  spec.push.reset();
  spec.pushes = {push, push, push, push};
  spec.pushes[1].trigger = PhaseTrigger{engine::WalkingState::single_support, Side::left, 0.5};
  spec.pushes[2].trigger = TimeTrigger{8.0};
  spec.pushes[3].impulse_ns = 0.05;
  const TrialResult result = run_trial(spec, robot);
  EXPECT_EQ(result.outcome, TrialOutcome::recovered);
  ASSERT_EQ(result.pushes.size(), 4U);
  EXPECT_EQ(result.pushes[0].start_tick, 3000U);
  EXPECT_EQ(result.pushes[0].end_tick, 3049U);
  EXPECT_GT(result.pushes[1].start_tick.value(), 3049U);
  EXPECT_LT(result.pushes[1].start_tick.value(), 4000U);
  EXPECT_EQ(result.pushes[2].start_tick, 8000U);
  EXPECT_EQ(result.pushes[3].start_tick, 8050U);
  EXPECT_NEAR(result.delivered_ns, 18.05, 1e-9);
  EXPECT_EQ(result.push_tick, 3000U);
  // The next one came before it was back.
  EXPECT_FALSE(result.pushes[2].recovery_time_s);
  EXPECT_TRUE(result.pushes[1].recovery_time_s);
  EXPECT_EQ(result.ticks, 8100U + 4000U);
}

TEST_F(TrialTest, APushThatFellsEndsTheList) {
  TrialSpec spec = spec_with(6.0);
  PushSpec push = *spec.push;
  spec.push.reset();
  spec.pushes = {push, push, push};
  spec.pushes[1].trigger = TimeTrigger{6.0};
  spec.pushes[1].impulse_ns = 150.0;
  spec.pushes[2].trigger = TimeTrigger{12.0};
  const TrialResult result = run_trial(spec, robot);
  EXPECT_EQ(result.outcome, TrialOutcome::fell);
  EXPECT_FALSE(result.pushes[0].fell);
  EXPECT_TRUE(result.pushes[0].recovery_time_s);
  EXPECT_TRUE(result.pushes[1].fell);
  EXPECT_FALSE(result.pushes[2].start_tick);
  spec.pushes = {push, push};
  spec.pushes[1].trigger = PhaseTrigger{engine::WalkingState::idle, {}, 0.5};
  const TrialResult waited = run_trial(spec, robot);
  EXPECT_EQ(waited.outcome, TrialOutcome::timeout);
  EXPECT_EQ(waited.pushes[0].start_tick, 3000U);
}

TEST_F(TrialTest, RepeatsToTheBit) {
  EXPECT_EQ(run_trial(spec_with(6.0), robot).state_hash,
            run_trial(spec_with(6.0), robot).state_hash);
  EXPECT_NE(run_trial(spec_with(6.0), robot).state_hash,
            run_trial(spec_with(6.1), robot).state_hash);
}

}  // namespace
}  // namespace stagger::sim
