#include "engine/step_limits.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "engine/sole_gap.h"

namespace stagger::engine {
namespace {

/// Feet so long, beside each other, that toes meet in a turn.
Parameters with_long_feet() {
  Parameters p;
  p.foot_half_length = 0.13;
  p.foot_half_width = 0.05;
  p.min_step_width = 0.115;
  return p;
}

StepFault check(const Parameters& p, const Vec2& offset, double turn) {
  const Footstep stance{{0.3, -0.2}, 0.7, Side::left};
  const Footstep step{stance.position + rotated(offset, stance.yaw), stance.yaw + turn,
                      Side::right};
  return check_step(stance, step, ReachRegion(p), p);
}

TEST(StepLimits, TellWhatIsWrong) {
  const Parameters p = with_long_feet();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check(p, {0.0, -0.2}, 0.0), StepFault::none);
  EXPECT_EQ(check(p, {1.0, -0.2}, 0.0), StepFault::out_of_reach);
  EXPECT_EQ(check(p, {0.0, -0.11}, 0.0), StepFault::out_of_reach);
  EXPECT_EQ(check(p, {0.0, 0.2}, 0.0), StepFault::out_of_reach);
  EXPECT_EQ(check(p, {nan, -0.2}, 0.0), StepFault::out_of_reach);
  EXPECT_EQ(check(p, {0.0, -0.2}, nan), StepFault::turns_too_far);
  EXPECT_EQ(check(p, {0.0, -0.3}, -0.7), StepFault::turns_too_far);
  EXPECT_EQ(check(p, {0.0, -0.3}, 2 * M_PI - 0.2), StepFault::none);
  EXPECT_EQ(check(p, {0.0, -0.12}, 0.3), StepFault::soles_too_near);   // toes
  EXPECT_EQ(check(p, {0.0, -0.12}, -0.3), StepFault::soles_too_near);  // heels
  EXPECT_EQ(check(p, {0.4, -0.12}, 0.3), StepFault::none);
}

/// Random wishes, far beyond the limits too.
void expect_nearest_steps_keep_the_limits(const Parameters& p) {
  const ReachRegion reach(p);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-1.2, 1.2);
  std::uniform_real_distribution<double> angle(-1.0, 1.0);
  int moved = 0;
  for (int i = 0; i < 20000; ++i) {
    const Side side = i % 2 == 0 ? Side::left : Side::right;
    const Footstep stance{{place(random), place(random)}, 3.0 * angle(random), side};
    const Footstep wanted{stance.position + Vec2(place(random), 0.3 * place(random)),
                          stance.yaw + angle(random), other(side)};
    const Footstep step = nearest_step(stance, wanted, reach, p);
    ASSERT_EQ(check_step(stance, step, reach, p), StepFault::none) << i;
    if (check_step(stance, wanted, reach, p) == StepFault::none) {
      ASSERT_LT((step.position - wanted.position).norm(), 1e-12) << i;
      ASSERT_EQ(step.yaw, wanted.yaw) << i;
    } else {
      ++moved;
    }
  }
  EXPECT_GT(moved, 1000);
  EXPECT_LT(moved, 19900);
}

TEST(StepLimits, NearestStepKeepsThemAndLeavesGoodStepsAlone) {
  expect_nearest_steps_keep_the_limits(Parameters());
  expect_nearest_steps_keep_the_limits(with_long_feet());
  Parameters narrow = with_long_feet();
  narrow.max_step_width = 0.21;  // hardly wider than the stance
  expect_nearest_steps_keep_the_limits(narrow);
}

TEST(StepLimits, CrossingLandsBeforeOrBehindButNeverOnTheStanceFoot) {
  Parameters p = with_long_feet();
  p.allow_crossing = true;
  p.min_step_width = -0.15;
  expect_nearest_steps_keep_the_limits(p);
  EXPECT_EQ(check(p, {0.4, 0.1}, 0.0), StepFault::none);
  EXPECT_EQ(check(p, {0.1, 0.05}, 0.0), StepFault::soles_too_near);
  EXPECT_EQ(check(p, {0.4, 0.16}, 0.0), StepFault::out_of_reach);
}

TEST(StepLimits, TheCorrectionIsNoLongerThanNeeded) {
  const Parameters p = with_long_feet();
  const ReachRegion reach(p);
  const Footstep stance{{0.0, 0.0}, 0.0, Side::left};
  const Footstep wanted{{0.05, -0.12}, 0.4, Side::right};
  const Footstep step = nearest_step(stance, wanted, reach, p);
  EXPECT_EQ(step.yaw, wanted.yaw);
  EXPECT_NEAR(sole_gap(whole_sole(p), step.position, step.yaw), p.foot_clearance, 1e-6);
}

}  // namespace
}  // namespace stagger::engine
