#include "engine/state_machine.h"

#include <gtest/gtest.h>

namespace stagger::engine {
namespace {

constexpr double dt = 0.001;

/// Runs for a time with the swing foot landing when `loaded` says so; returns the last transition.
Transition run(StateMachine& machine, double seconds, bool loaded = true) {
  Transition last = Transition::none;
  const int ticks = static_cast<int>(std::lround(seconds / dt));
  for (int i = 0; i < ticks; ++i) {
    // A foot that stands is loaded; in the first half of the swing load does not count.
    while (true) {
      const bool touching = loaded && machine.time() >= machine.t_ss() - 1e-9;
      const Transition t = machine.advance({touching});
      if (t == Transition::none) break;
      last = t;
    }
    machine.pass(dt);
  }
  return last;
}

TEST(StateMachine, StandsUntilItIsTold) {
  StateMachine machine{Parameters()};
  EXPECT_EQ(run(machine, 1.0), Transition::none);
  EXPECT_EQ(machine.state(), WalkingState::idle);
}

TEST(StateMachine, WalksThroughItsStatesInTime) {
  const Parameters parameters;
  StateMachine machine(parameters);
  machine.start();
  run(machine, 0.5);
  EXPECT_EQ(machine.state(), WalkingState::initialize);
  run(machine, parameters.t_init - 0.5 + 0.1);
  EXPECT_EQ(machine.state(), WalkingState::single_support);
  EXPECT_EQ(machine.support_side(), Side::left);
  run(machine, parameters.t_ss);
  EXPECT_EQ(machine.state(), WalkingState::double_support);
  EXPECT_EQ(machine.support_side(), Side::left);
  EXPECT_EQ(machine.landings(), 1U);
  run(machine, parameters.t_ds);
  EXPECT_EQ(machine.state(), WalkingState::single_support);
  EXPECT_EQ(machine.support_side(), Side::right);
  EXPECT_NEAR(machine.time(), 0.1, 2 * dt);
}

TEST(StateMachine, ManyStepsKeepTheBeat) {
  const Parameters parameters;
  StateMachine machine(parameters);
  machine.start();
  run(machine, parameters.t_init + 100 * (parameters.t_ss + parameters.t_ds) + 0.5);
  EXPECT_EQ(machine.landings(), 100U);
}

TEST(StateMachine, EarlyLandingEndsSingleSupport) {
  const Parameters parameters;
  StateMachine machine(parameters);
  machine.start();
  run(machine, parameters.t_init + 0.7 * parameters.t_ss);
  ASSERT_EQ(machine.state(), WalkingState::single_support);
  EXPECT_EQ(machine.advance({true}), Transition::landing);
  EXPECT_NEAR(machine.t_ss(), 0.7 * parameters.t_ss, 2 * dt);
}

TEST(StateMachine, LoadRightAfterLiftOffIsNoLanding) {
  const Parameters parameters;
  StateMachine machine(parameters);
  machine.start();
  run(machine, parameters.t_init + 0.2 * parameters.t_ss);
  EXPECT_EQ(machine.advance({true}), Transition::none);
}

TEST(StateMachine, WaitsForALateLandingButNotForEver) {
  const Parameters parameters;
  StateMachine machine(parameters);
  machine.start();
  run(machine, parameters.t_init + parameters.t_ss + 0.5 * parameters.landing_patience, false);
  EXPECT_EQ(machine.state(), WalkingState::single_support);
  EXPECT_EQ(machine.single_support_left(), 0.0);
  run(machine, parameters.landing_patience, false);
  EXPECT_EQ(machine.state(), WalkingState::double_support);
}

TEST(StateMachine, StopsAfterOneWholeStepMore) {
  const Parameters parameters;
  StateMachine machine(parameters);
  machine.start();
  run(machine, parameters.t_init + 0.1);
  machine.stop();
  EXPECT_EQ(machine.steps_ahead(), 2U);
  run(machine, 2 * parameters.t_ss + parameters.t_ds);
  EXPECT_EQ(machine.landings(), 2U);
  EXPECT_EQ(machine.state(), WalkingState::double_support);
  EXPECT_EQ(run(machine, parameters.t_init + 0.2), Transition::stand);
  EXPECT_EQ(machine.state(), WalkingState::idle);
  EXPECT_EQ(machine.landings(), 2U);
}

TEST(StateMachine, LateInASwingAStopTakesOneStepMore) {
  const Parameters parameters;
  StateMachine machine(parameters);
  machine.start();
  run(machine, parameters.t_init + 0.6 * parameters.t_ss);
  machine.stop();
  EXPECT_EQ(machine.steps_ahead(), 3U);
  machine.stop();  // to say it twice changes nothing
  EXPECT_EQ(machine.steps_ahead(), 3U);
  run(machine, 4.0);
  EXPECT_EQ(machine.landings(), 3U);
  EXPECT_EQ(machine.state(), WalkingState::idle);
}

TEST(StateMachine, AStartInTheLastStepShiftsTheWeightAfterItsLanding) {
  const Parameters parameters;
  for (const double later : {0.3, 0.8 + 0.5}) {  // before that landing, and while it closes
    StateMachine machine(parameters);
    machine.start(1);
    run(machine, parameters.t_init + later);
    machine.start(2);
    run(machine, std::max(0.8 - later, 0.0) + 0.01);
    EXPECT_EQ(machine.state(), WalkingState::initialize) << later;
    EXPECT_EQ(machine.support_side(), Side::right) << later;
    run(machine, parameters.t_init + 3.5);
    EXPECT_EQ(machine.landings(), 3U) << later;
    EXPECT_EQ(machine.state(), WalkingState::idle) << later;
  }
}

TEST(StateMachine, AFurtherStepCanFollowTheLast) {
  const Parameters parameters;
  StateMachine machine(parameters);
  machine.start(1);
  run(machine, parameters.t_init + parameters.t_ss + 0.05);
  ASSERT_TRUE(machine.closing());
  machine.step_again();
  EXPECT_FALSE(machine.closing());
  run(machine, parameters.t_ds + parameters.t_ss + parameters.t_init + 0.1);
  EXPECT_EQ(machine.landings(), 2U);
  EXPECT_EQ(machine.state(), WalkingState::idle);
}

TEST(StateMachine, RecoversOnEitherFootAndComesToStand) {
  const Parameters parameters;
  for (const Side side : {Side::left, Side::right}) {
    StateMachine machine(parameters);
    run(machine, 0.1);
    machine.recover(side);
    EXPECT_EQ(machine.state(), WalkingState::single_support);
    EXPECT_EQ(machine.support_side(), side);
    EXPECT_EQ(machine.time(), 0.0);
    run(machine, 5.0);
    EXPECT_EQ(machine.landings(), 2U);
    EXPECT_EQ(machine.state(), WalkingState::idle);
  }
}

TEST(StateMachine, AWalkGoesOnAfterARecovery) {
  StateMachine machine{Parameters()};
  machine.start();
  run(machine, 0.3);
  machine.recover(Side::right);
  EXPECT_EQ(machine.state(), WalkingState::single_support);
  run(machine, 10.0);
  EXPECT_EQ(machine.landings(), 10U);
}

TEST(StateMachine, RecoversFromAClosingDoubleSupportAndFromNoOther) {
  const Parameters parameters;
  StateMachine machine(parameters);
  machine.start(2);
  run(machine, parameters.t_init + parameters.t_ss + 0.1);
  ASSERT_EQ(machine.state(), WalkingState::double_support);
  EXPECT_FALSE(machine.stands());
  machine.recover(Side::left);
  EXPECT_EQ(machine.state(), WalkingState::double_support);
  run(machine, parameters.t_ds + parameters.t_ss);
  ASSERT_TRUE(machine.stands());
  machine.recover(Side::left);
  EXPECT_EQ(machine.state(), WalkingState::single_support);
  EXPECT_FALSE(machine.closing());
  run(machine, 5.0);
  EXPECT_EQ(machine.landings(), 4U);
  EXPECT_EQ(machine.state(), WalkingState::idle);
}

TEST(StateMachine, StopDuringTheWeightShiftStandsAtOnce) {
  StateMachine machine{Parameters()};
  machine.start();
  run(machine, 0.3);
  machine.stop();
  EXPECT_EQ(run(machine, 0.01), Transition::stand);
  EXPECT_EQ(machine.landings(), 0U);
}

TEST(StateMachine, DoubleSupportMayLastNoTime) {
  Parameters parameters;
  parameters.t_ds = 0.0;
  StateMachine machine(parameters);
  machine.start();
  run(machine, parameters.t_init + 10 * parameters.t_ss + 0.1);
  EXPECT_EQ(machine.landings(), 10U);
  EXPECT_EQ(machine.state(), WalkingState::single_support);
}

}  // namespace
}  // namespace stagger::engine
