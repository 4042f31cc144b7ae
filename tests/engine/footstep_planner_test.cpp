#include "engine/footstep_planner.h"

#include <gtest/gtest.h>

namespace stagger::engine {
namespace {

TEST(FootstepPlanner, StepsInPlace) {
  const Parameters parameters;
  const ReachRegion reach(parameters);
  const Footstep stance{{1.0, 0.1}, 0.0, Side::left};
  const Footstep next = next_footstep(stance, {}, 0.5, parameters.stance_width, reach);
  EXPECT_EQ(next.side, Side::right);
  EXPECT_LT((next.position - Vec2(1.0, -0.1)).norm(), 1e-12);
  const Footstep back = next_footstep(next, {}, 0.5, parameters.stance_width, reach);
  EXPECT_LT((back.position - stance.position).norm(), 1e-12);
}

TEST(FootstepPlanner, VelocityIsDistanceOverTime) {
  const Parameters parameters;
  const ReachRegion reach(parameters);
  const WalkCommand command{0.3, -0.1, 0.0};
  Footstep step{{0.0, 0.1}, 0.0, Side::left};
  const Vec2 start = step.position;
  for (int i = 0; i < 20; ++i)
    step = next_footstep(step, command, 0.5, parameters.stance_width, reach);
  EXPECT_NEAR(step.position.x() - start.x(), 0.3 * 10.0, 1e-9);
  EXPECT_NEAR(step.position.y() - start.y(), -0.1 * 10.0, 1e-9);
}

TEST(FootstepPlanner, FeetNeverComeCloserThanTheStanceWidth) {
  const Parameters parameters;
  const ReachRegion reach(parameters);
  Footstep step{{0.0, 0.1}, 0.0, Side::left};
  for (int i = 0; i < 10; ++i) {
    const Footstep next = next_footstep(step, {0.0, 0.2, 0.0}, 0.5, parameters.stance_width, reach);
    EXPECT_GE((next.position - step.position).norm(), parameters.stance_width - 1e-12);
    step = next;
  }
}

TEST(FootstepPlanner, TurnsAboutTheMiddle) {
  const Parameters parameters;
  const ReachRegion reach(parameters);
  Footstep step{{0.0, 0.1}, 0.0, Side::left};
  for (int i = 0; i < 40; ++i)
    step = next_footstep(step, {0.0, 0.0, 0.3}, 0.5, parameters.stance_width, reach);
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

}  // namespace
}  // namespace stagger::engine
