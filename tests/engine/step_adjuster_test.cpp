#include "engine/step_adjuster.h"

#include <gtest/gtest.h>

#include "engine/lipm.h"
#include "engine/reference.h"
#include "tests/engine/omega.h"

namespace stagger::engine {
namespace {

/// A forward gait of 0.5 m steps, `left` seconds before touchdown, DCM off by `error`.
StepSituation forward_gait(double t_ss, double t_ds, double left, const Vec2& error) {
  StepSituation s;
  s.stance = {{1.0, 0.0}, 0.0, Side::left};
  s.planned = {{1.5, -0.2}, 0.0, Side::right};
  const Vec2 first(0.5, -0.2);
  const Vec2 second(0.5, 0.2);
  const Vec2 offset = periodic_dcm_offset(second, first, t_ss, t_ds, omega);
  const ZmpSegment transfer{t_ds, s.stance.position, s.planned.position};
  s.nominal_dcm = dcm_before(transfer, s.planned.position + offset, 0.0, omega);
  const ZmpSegment single{t_ss, s.stance.position, s.stance.position};
  s.dcm = dcm_before(single, s.nominal_dcm, t_ss - left, omega) + error;
  s.transfer = transfer_factor(t_ds, omega);
  return s;
}

StepAdjustment adjust(const StepSituation& situation, double left, const Parameters& p = {}) {
  return adjust_step(situation, left, omega, ReachRegion(p), p);
}

TEST(StepAdjuster, LeavesTheNominalGaitAlone) {
  for (const double t_ds : {0.0, 0.2}) {
    const auto result = adjust(forward_gait(0.8, t_ds, 0.5, Vec2::Zero()), 0.5);
    EXPECT_LT(result.error.norm(), 1e-12);
    EXPECT_FALSE(result.adjusted);
    EXPECT_EQ(result.step.position, Vec2(1.5, -0.2));
  }
}

TEST(StepAdjuster, TheAdjustedStepMeetsTheDcm) {
  // After the adjusted step the DCM must lie where the plan wants it relative to the new foot.
  const double t_ds = 0.2;
  const StepSituation s = forward_gait(0.8, t_ds, 0.5, {0.03, 0.01});
  const auto result = adjust(s, 0.5);
  ASSERT_TRUE(result.adjusted);
  const auto dcm_after_transfer = [&](const Vec2& touchdown, const Vec2& foot) {
    const ZmpSegment transfer{t_ds, s.stance.position, foot};
    const Vec2 lead = transfer.velocity() / omega;
    return Vec2(foot + lead + (touchdown - s.stance.position - lead) * std::exp(omega * t_ds));
  };
  const Vec2 touchdown = dcm_after(s.dcm, s.stance.position, 0.5, omega);
  const Vec2 offset = dcm_after_transfer(touchdown, result.step.position) - result.step.position;
  const Vec2 nominal = dcm_after_transfer(s.nominal_dcm, s.planned.position) - s.planned.position;
  EXPECT_LT((offset - nominal).norm(), 1e-12);
}

TEST(StepAdjuster, StepsTowardsThePush) {
  EXPECT_GT(adjust(forward_gait(0.8, 0.2, 0.5, {0.05, 0.0}), 0.5).step.position.x(), 1.5);
  EXPECT_LT(adjust(forward_gait(0.8, 0.2, 0.5, {-0.05, 0.0}), 0.5).step.position.x(), 1.5);
}

TEST(StepAdjuster, IgnoresErrorsInsideTheMargin) {
  Parameters parameters;
  parameters.step_margin = 0.10;
  const auto small = adjust(forward_gait(0.8, 0.2, 0.1, {0.01, 0.0}), 0.1, parameters);
  EXPECT_GT(small.error.norm(), 0.0);
  EXPECT_FALSE(small.adjusted);
  EXPECT_EQ(small.step.position, Vec2(1.5, -0.2));
}

TEST(StepAdjuster, StopsAtWhatTheLegReaches) {
  Parameters parameters;
  const auto far = adjust(forward_gait(0.8, 0.2, 0.7, {0.3, 0.3}), 0.7, parameters);
  EXPECT_DOUBLE_EQ(far.step.position.x(), 1.0 + parameters.max_step_length);
  EXPECT_DOUBLE_EQ(far.step.position.y(),
                   -parameters.min_step_width);  // never across the stance foot
}

/// Time left at which a reachable foothold catches the DCM best.
double best_time(const StepSituation& situation, double nominal) {
  return adjust_time(situation, nominal, nominal - 0.2, nominal + 0.2, omega,
                     ReachRegion(Parameters()));
}

TEST(StepTime, StaysAsItIsWhileAStepCanCatchTheDcm) {
  EXPECT_DOUBLE_EQ(best_time(forward_gait(0.8, 0.2, 0.5, {0.02, 0.01}), 0.5), 0.5);
}

TEST(StepTime, IsJustSoShortThatTheLongestStepReaches) {
  const StepSituation s = forward_gait(0.8, 0.2, 0.5, {0.08, 0.0});
  const double left = best_time(s, 0.5);
  ASSERT_LT(left, 0.5);
  ASSERT_GT(left, 0.3);
  const Vec2 foothold = catching_line(s).foothold(std::exp(omega * left));
  EXPECT_NEAR(foothold.x(), s.stance.position.x() + Parameters().max_step_length, 1e-9);
}

TEST(StepTime, IsTheShortestWhenNothingReaches) {
  EXPECT_NEAR(best_time(forward_gait(0.8, 0.2, 0.5, {0.4, 0.0}), 0.5), 0.3, 1e-12);
}

TEST(StepTime, GrowsWhenTheFeetWouldComeTooClose) {
  // Pushed outwards a little: the catching step is narrow; later it is wide enough.
  StepSituation s = forward_gait(0.8, 0.2, 0.5, Vec2::Zero());
  s.dcm.y() = s.stance.position.y() + 0.3 * (s.dcm.y() - s.stance.position.y());
  const double left = best_time(s, 0.5);
  ASSERT_GT(left, 0.5);
  const Vec2 foothold = catching_line(s).foothold(std::exp(omega * left));
  EXPECT_LE(foothold.y(), s.stance.position.y() - Parameters().min_step_width + 1e-9);
}

TEST(StepTime, StaysWhenNoTimeIsNearer) {
  // Only the width is out of reach, and that by as much at any time: the DCM is above the foot's
  // mid-line, whither its way runs parallel to the edge.
  StepSituation s = forward_gait(0.8, 0.2, 0.5, Vec2::Zero());
  s.dcm.y() = s.stance.position.y();
  EXPECT_DOUBLE_EQ(best_time(s, 0.5), 0.5);
}

TEST(StepTime, FindsTheLeastDistanceByAnyOther) {
  // Against a fine search over the whole interval.
  for (const Vec2& error :
       {Vec2(0.3, -0.2), Vec2(-0.25, 0.1), Vec2(0.02, 0.2), Vec2(0.2, 0.1), Vec2(0.05, 0.02)}) {
    const StepSituation s = forward_gait(0.8, 0.2, 0.5, error);
    const ReachRegion reach{Parameters()};
    const auto distance = [&](double left) {
      const Vec2 step = catching_line(s).foothold(std::exp(omega * left)) - s.stance.position;
      return (step - reach.polygon(Side::left).clamp(step)).norm();
    };
    double least = 1e9;
    for (int i = 0; i <= 4000; ++i) least = std::min(least, distance(0.3 + 0.0001 * i));
    EXPECT_LE(distance(best_time(s, 0.5)), least + 1e-9) << error.transpose();
  }
}

TEST(ReachRegion, ScaledLengthLeavesTheWidth) {
  Parameters parameters;
  parameters.max_step_back = 0.4;
  const ReachRegion reach = ReachRegion(parameters).scaled_length(0.5);
  for (const Side side : {Side::left, Side::right}) {
    const double outward = -lateral_sign(side);
    const Footstep stance{Vec2::Zero(), 0.0, side};
    const Vec2 far = reach.clamp(stance, {9.0, 9.0 * outward});
    EXPECT_NEAR(far.x(), 0.5 * parameters.max_step_length, 1e-12);
    EXPECT_NEAR(far.y() * outward, parameters.max_step_width, 1e-12);
    EXPECT_NEAR(reach.clamp(stance, {-9.0, 0.0}).x(), -0.5 * parameters.max_step_back, 1e-12);
    EXPECT_NEAR(reach.clamp(stance, Vec2::Zero()).y() * outward, parameters.min_step_width, 1e-12);
  }
}

}  // namespace
}  // namespace stagger::engine
