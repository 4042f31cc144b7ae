#include "sim/experiment/recovery.h"

#include <gtest/gtest.h>

namespace stagger::sim {
namespace {

Frame frame(std::uint64_t tick, double error, WalkingState state = WalkingState::single_support) {
  Frame f;
  f.tick = tick;
  f.state = state;
  f.dcm_reference = Vec2(1.0, 2.0);
  f.dcm = f.dcm_reference + Vec2(0.0, error);
  return f;
}

Event step(std::uint64_t tick, double adjustment) {
  return {tick, 0.0, EventKind::step, "", {{"adjustment", adjustment}}};
}

TEST(Recovery, IsNeverAwayWithoutADisturbance) {
  Recovery recovery(false);
  for (std::uint64_t i = 5; i < 9; ++i) recovery.look(frame(i, 0.002));
  recovery.take({step(6, 0.001)});
  EXPECT_EQ(recovery.back_tick(), 0U);
  EXPECT_EQ(recovery.steps(), 0U);
}

TEST(Recovery, IsBackAfterTheLastTickThatTheDcmWasAway) {
  Recovery recovery(false);
  recovery.look(frame(10, 0.1));
  recovery.look(frame(11, 0.01));
  recovery.look(frame(12, -0.031));
  EXPECT_FALSE(recovery.back_tick());
  recovery.look(frame(13, 0.03));
  EXPECT_EQ(recovery.back_tick(), 13U);
}

TEST(Recovery, IsNotBackWhileARecoveryStepIsUnderWay) {
  Recovery recovery(false);
  Frame stepping = frame(10, 0.0);
  stepping.adjusted_step.position = {0.04, 0.0};
  recovery.look(stepping);
  EXPECT_FALSE(recovery.back_tick());
  stepping.tick = 11;
  stepping.planned_step.position = {0.02, 0.0};
  recovery.look(stepping);
  EXPECT_EQ(recovery.back_tick(), 11U);
}

TEST(Recovery, CountsTheStepsToTheLastRecoveryStep) {
  Recovery recovery(false);
  recovery.take({step(15, 0.2), step(50, 0.04), step(90, 0.001)});
  EXPECT_EQ(recovery.steps(), 2U);
}

TEST(Recovery, WhoIsToStandIsBackWhenItStands) {
  Recovery stand(true);
  stand.look(frame(10, 0.0, WalkingState::double_support));
  EXPECT_FALSE(stand.back_tick());
  stand.look(frame(11, 0.0, WalkingState::idle));
  EXPECT_EQ(stand.back_tick(), 11U);

  Recovery walk(false);
  walk.look(frame(10, 0.0, WalkingState::idle));
  EXPECT_FALSE(walk.back_tick());
}

}  // namespace
}  // namespace stagger::sim
