#include "engine/footstep_planner.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "engine/sole_gap.h"

namespace stagger::engine {
namespace {

/// One step of a walk that takes `step_time` for each.
Footstep next_footstep(const Footstep& stance, const WalkCommand& command, double step_time,
                       Parameters parameters, const ReachRegion& reach) {
  parameters.t_ss = step_time - parameters.t_ds;
  return engine::next_footstep(stance, step_pattern(command, reach, parameters));
}

TEST(FootstepPlanner, StepsInPlace) {
  const Parameters parameters;
  const ReachRegion reach(parameters);
  const Footstep stance{{1.0, 0.1}, 0.0, Side::left};
  const Footstep next = next_footstep(stance, {}, 0.5, parameters, reach);
  EXPECT_EQ(next.side, Side::right);
  EXPECT_LT((next.position - Vec2(1.0, -0.1)).norm(), 1e-12);
  const Footstep back = next_footstep(next, {}, 0.5, parameters, reach);
  EXPECT_LT((back.position - stance.position).norm(), 1e-12);
}

TEST(FootstepPlanner, VelocityIsDistanceOverTime) {
  const Parameters parameters;
  const ReachRegion reach(parameters);
  const WalkCommand command{0.3, -0.1, 0.0};
  Footstep step{{0.0, 0.1}, 0.0, Side::left};
  const Vec2 start = step.position;
  for (int i = 0; i < 20; ++i) step = next_footstep(step, command, 0.5, parameters, reach);
  EXPECT_NEAR(step.position.x() - start.x(), 0.3 * 10.0, 1e-9);
  EXPECT_NEAR(step.position.y() - start.y(), -0.1 * 10.0, 1e-9);
}

TEST(FootstepPlanner, FeetNeverComeCloserThanTheStanceWidth) {
  const Parameters parameters;
  const ReachRegion reach(parameters);
  Footstep step{{0.0, 0.1}, 0.0, Side::left};
  for (int i = 0; i < 10; ++i) {
    const Footstep next = next_footstep(step, {0.0, 0.2, 0.0}, 0.5, parameters, reach);
    EXPECT_GE((next.position - step.position).norm(), parameters.stance_width - 1e-12);
    step = next;
  }
}

TEST(FootstepPlanner, TurnsAboutTheMiddle) {
  const Parameters parameters;
  const ReachRegion reach(parameters);
  Footstep step{{0.0, 0.1}, 0.0, Side::left};
  for (int i = 0; i < 40; ++i) step = next_footstep(step, {0.0, 0.0, 0.3}, 0.5, parameters, reach);
  EXPECT_NEAR(step.yaw, 0.3 * 20.0, 1e-9);
  EXPECT_LT(step.position.norm(), 0.2);  // has not walked away
}

TEST(FootstepPlanner, ReachKeepsTheSideInTheStanceFrame) {
  const Parameters parameters;
  const ReachRegion reach(parameters);
  const Footstep stance{{1.0, 2.0}, 1.0, Side::right};
  const Vec2 wanted = stance.position + rotated({5.0, -1.0}, 1.0);
  const Vec2 in_stance = rotated(reach.clamp(stance, wanted) - stance.position, -stance.yaw);
  EXPECT_NEAR(in_stance.x(), parameters.max_step_length, 1e-12);
  EXPECT_NEAR(in_stance.y(), parameters.min_step_width, 1e-12);
}

/// Feet that are long for their distance: toes meet in a turn.
Parameters long_feet() {
  Parameters p;
  p.t_ss = 0.5;
  p.t_ds = 0.1;
  p.stance_width = 0.16;
  p.foot_half_length = 0.13;
  p.foot_half_width = 0.05;
  p.min_step_width = 0.12;
  p.max_step_length = 0.4;
  p.max_step_width = 0.45;
  return p;
}

Parameters quick_gait() {
  Parameters p;
  p.t_ss = 0.4;
  p.t_ds = 0.1;
  return p;
}

class RandomWalks : public ::testing::TestWithParam<Parameters> {};

INSTANTIATE_TEST_SUITE_P(Robots, RandomWalks, ::testing::Values(quick_gait(), long_feet()));

/// Commands of every size: within the limits, at them, and far beyond.
WalkCommand random_command(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double size = std::pow(10.0, unit(random));
  return {size * unit(random), 0.5 * size * unit(random), size * unit(random)};
}

TEST_P(RandomWalks, NoTwoStepsBreakALimit) {
  const Parameters p = GetParam();
  const ReachRegion reach(p);
  std::mt19937 random(3);
  Footstep step{{0.0, 0.1}, 0.0, Side::left};
  int whole = 0;
  for (int i = 0; i < 4000; ++i) {  // commands, each for one to five steps
    const WalkCommand wish = random_command(random);
    const StepPattern pattern = step_pattern(wish, reach, p);
    if (pattern.command.vx == wish.vx) ++whole;
    for (int n = 0; n <= i % 5; ++n) {
      const Footstep next = engine::next_footstep(step, pattern);
      ASSERT_EQ(check_step(step, next, reach, p), StepFault::none)
          << i << ": " << wish.vx << ", " << wish.vy << ", " << wish.wz;
      step = next;
    }
    if (step.position.norm() > 10.0) step.position.setZero();
  }
  EXPECT_GT(whole, 500);
  EXPECT_LT(whole, 3500);
}

TEST_P(RandomWalks, TheCommandIsWalkedOrCutAlongItsPathAsLittleAsCanBe) {
  const Parameters p = GetParam();
  const ReachRegion reach(p);
  std::mt19937 random(4);
  for (int i = 0; i < 1000; ++i) {
    const WalkCommand wish = random_command(random);
    const StepPattern pattern = step_pattern(wish, reach, p);
    const double share = pattern.command.vx / wish.vx;
    ASSERT_GT(share, 0.0);
    ASSERT_LE(share, 1.0);
    ASSERT_NEAR(pattern.command.vy, share * wish.vy, 1e-12);
    ASSERT_NEAR(pattern.command.wz, share * wish.wz, 1e-12);
    if (share == 1.0) continue;
    // A little more breaks a limit, at the same step time.
    Parameters same_times = p;
    same_times.t_ss = same_times.least_t_ss = pattern.times.t_ss;
    const double more = 1.001 * share;
    const StepPattern again =
        step_pattern({more * wish.vx, more * wish.vy, more * wish.wz}, reach, same_times);
    ASSERT_NEAR(again.command.vx, pattern.command.vx, 1e-9 + 1e-6 * std::abs(wish.vx)) << i;
  }
}

TEST_P(RandomWalks, MirroredCommandsGiveMirroredSteps) {
  const Parameters p = GetParam();
  const ReachRegion reach(p);
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    const WalkCommand wish = random_command(random);
    const StepPattern one = step_pattern(wish, reach, p);
    const StepPattern two = step_pattern({wish.vx, -wish.vy, -wish.wz}, reach, p);
    Footstep a{{0.0, 0.1}, 0.2, Side::left};
    Footstep b{{0.0, -0.1}, -0.2, Side::right};
    for (int n = 0; n < 4; ++n) {
      a = engine::next_footstep(a, one);
      b = engine::next_footstep(b, two);
      ASSERT_NEAR(a.position.x(), b.position.x(), 1e-9) << i;
      ASSERT_NEAR(a.position.y(), -b.position.y(), 1e-9) << i;
      ASSERT_NEAR(a.yaw, -b.yaw, 1e-12) << i;
      ASSERT_EQ(a.side, other(b.side));
    }
  }
}

TEST_P(RandomWalks, TheBodyMovesByTheTwistOfTheCommandThatIsWalked) {
  const Parameters p = GetParam();
  const ReachRegion reach(p);
  std::mt19937 random(6);
  for (int i = 0; i < 1000; ++i) {
    const StepPattern pattern = step_pattern(random_command(random), reach, p);
    const double time = pattern.times.step();
    Footstep step{{0.3, -0.4}, 0.0, i % 2 == 0 ? Side::left : Side::right};
    // Where body and heading go at constant velocities, by integration in small steps.
    Vec2 middle = Vec2::Zero();
    double heading = 0.0;
    constexpr int parts = 2000;
    for (int n = 0; n < parts; ++n) {
      const double dt = 6.0 * time / parts;
      const double half_way = heading + 0.5 * dt * pattern.command.wz;
      middle += dt * rotated({pattern.command.vx, pattern.command.vy}, half_way);
      heading += dt * pattern.command.wz;
    }
    const auto body_of = [&](const Footstep& stance) {
      const Vec2 side(0.0, lateral_sign(other(stance.side)) * pattern.half_width);
      return Vec2(stance.position + rotated(side, stance.yaw));
    };
    const Vec2 start = body_of(step);
    for (int n = 0; n < 6; ++n) step = engine::next_footstep(step, pattern);
    ASSERT_NEAR(step.yaw, heading, 1e-9);
    ASSERT_LT((body_of(step) - start - middle).norm(), 1e-5) << i;
  }
}

TEST(FootstepPlanner, AStraightWalkIsCutToTheLongestStepThatWay) {
  Parameters p = quick_gait();
  p.max_step_back = 0.5 * p.max_step_length;
  for (const double length : {p.max_step_length, -p.max_step_back}) {
    const StepPattern pattern = step_pattern({10.0 * length, 0.0, 0.0}, ReachRegion(p), p);
    EXPECT_NEAR(pattern.offset[0].x(), length, 1e-9);
    EXPECT_NEAR(pattern.command.vx, length / pattern.times.step(), 1e-9);
  }
}

TEST(StepTimes, AreShorterAtALowerSpeedBackThanForwardIfStepsBackAre) {
  Parameters p = quick_gait();
  p.max_step_back = 0.5 * p.max_step_length;
  const double speed = 0.5 * p.max_step_length / (p.t_ss + p.t_ds);
  EXPECT_DOUBLE_EQ(step_times({speed, 0.0, 0.0}, p).t_ss, p.t_ss);
  EXPECT_LT(step_times({-speed, 0.0, 0.0}, p).t_ss, p.t_ss);
}

TEST(FootstepPlanner, ASidewaysWalkIsCutToTheWidestStep) {
  const Parameters p = quick_gait();
  const StepPattern pattern = step_pattern({0.0, -5.0, 0.0}, ReachRegion(p), p);
  EXPECT_NEAR(pattern.offset[index(Side::left)].y(), -p.max_step_width, 1e-9);
  EXPECT_NEAR(pattern.offset[index(Side::right)].y(), p.stance_width, 1e-9);
}

TEST(FootstepPlanner, ATurnIsCutToTheGreatest) {
  const Parameters p = quick_gait();
  const StepPattern pattern = step_pattern({0.0, 0.0, -9.0}, ReachRegion(p), p);
  EXPECT_NEAR(pattern.turn, -p.max_step_turn, 1e-9);
}

TEST(FootstepPlanner, TurningOnTheSpotKeepsLongFeetApartAndTheFullRate) {
  Parameters p = long_feet();
  p.stance_width = 0.13;
  const ReachRegion reach(p);
  for (const double wz : {0.5, -0.5}) {
    const StepPattern pattern = step_pattern({0.0, 0.0, wz}, reach, p);
    EXPECT_EQ(pattern.command.wz, wz);
    EXPECT_GT(pattern.half_width, 0.5 * p.stance_width);  // and no more than just enough:
    for (const Vec2& offset : pattern.offset) {
      EXPECT_NEAR(sole_gap(whole_sole(p), offset, pattern.turn), p.foot_clearance, 1e-9);
    }
  }
}

TEST(FootstepPlanner, WhatIsNotFiniteCountsAsNothing) {
  const Parameters p;
  const ReachRegion reach(p);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const StepPattern pattern = step_pattern({nan, 0.1, -infinity}, reach, p);
  EXPECT_EQ(pattern.command.vx, 0.0);
  EXPECT_EQ(pattern.command.vy, 0.1);
  EXPECT_EQ(pattern.command.wz, 0.0);
  const StepPattern huge = step_pattern({1e300, 1e300, 1e300}, reach, p);
  EXPECT_TRUE(huge.offset[0].allFinite());
}

TEST(FootstepPlanner, ARegionWithoutTheStanceWidthGetsItsNearestPlaces) {
  const Parameters p;
  const std::array<Vec2, 4> corners{Vec2(-0.1, -0.5), Vec2(0.1, -0.5), Vec2(0.1, -0.3),
                                    Vec2(-0.1, -0.3)};
  const StepPattern wide = step_pattern({}, ReachRegion(ConvexPolygon(corners)), p);
  EXPECT_NEAR(wide.offset[0].y(), -0.3, 1e-9);
  const std::array<Vec2, 4> close{Vec2(-0.1, -0.18), Vec2(0.1, -0.18), Vec2(0.1, -0.1),
                                  Vec2(-0.1, -0.1)};
  const StepPattern narrow = step_pattern({0.3, 0.0, 0.0}, ReachRegion(ConvexPolygon(close)), p);
  EXPECT_NEAR(narrow.offset[1].y(), 0.18, 1e-9);
  EXPECT_EQ(narrow.command.vx, 0.0);
}

}  // namespace
}  // namespace stagger::engine
