#include "engine/step_adjuster.h"

#include <gtest/gtest.h>

#include "engine/lipm.h"
#include "engine/reference.h"

namespace stagger::engine {
namespace {

const double omega = std::sqrt(9.81);

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
  s.time_left = left;
  s.transfer = transfer_factor(t_ds, omega);
  return s;
}

TEST(StepAdjuster, LeavesTheNominalGaitAlone) {
  for (const double t_ds : {0.0, 0.2}) {
    const auto result = adjust_step(forward_gait(0.8, t_ds, 0.5, Vec2::Zero()), omega, {});
    EXPECT_LT(result.error.norm(), 1e-12);
    EXPECT_FALSE(result.adjusted);
    EXPECT_EQ(result.step.position, Vec2(1.5, -0.2));
  }
}

TEST(StepAdjuster, TheAdjustedStepMeetsTheDcm) {
  // After the adjusted step the DCM must lie where the plan wants it relative to the new foot.
  const double t_ds = 0.2;
  const StepSituation s = forward_gait(0.8, t_ds, 0.5, {0.03, 0.01});
  const auto result = adjust_step(s, omega, {});
  ASSERT_TRUE(result.adjusted);
  const auto dcm_after_transfer = [&](const Vec2& touchdown, const Vec2& foot) {
    const ZmpSegment transfer{t_ds, s.stance.position, foot};
    const Vec2 lead = transfer.velocity() / omega;
    return Vec2(foot + lead + (touchdown - s.stance.position - lead) * std::exp(omega * t_ds));
  };
  const Vec2 touchdown = dcm_after(s.dcm, s.stance.position, s.time_left, omega);
  const Vec2 offset = dcm_after_transfer(touchdown, result.step.position) - result.step.position;
  const Vec2 nominal =
      dcm_after_transfer(s.nominal_dcm, s.planned.position) - s.planned.position;
  EXPECT_LT((offset - nominal).norm(), 1e-12);
}

TEST(StepAdjuster, StepsTowardsThePush) {
  EXPECT_GT(adjust_step(forward_gait(0.8, 0.2, 0.5, {0.05, 0.0}), omega, {}).step.position.x(), 1.5);
  EXPECT_LT(adjust_step(forward_gait(0.8, 0.2, 0.5, {-0.05, 0.0}), omega, {}).step.position.x(),
            1.5);
}

TEST(StepAdjuster, IgnoresErrorsInsideTheMargin) {
  Parameters parameters;
  parameters.step_margin = 0.10;
  const auto small = adjust_step(forward_gait(0.8, 0.2, 0.1, {0.01, 0.0}), omega, parameters);
  EXPECT_GT(small.error.norm(), 0.0);
  EXPECT_FALSE(small.adjusted);
  EXPECT_EQ(small.step.position, Vec2(1.5, -0.2));
}

TEST(StepAdjuster, StopsAtWhatTheLegReaches) {
  Parameters parameters;
  const auto far = adjust_step(forward_gait(0.8, 0.2, 0.7, {0.3, 0.3}), omega, parameters);
  EXPECT_DOUBLE_EQ(far.step.position.x(), 1.0 + parameters.max_step_length);
  EXPECT_DOUBLE_EQ(far.step.position.y(), -parameters.min_step_width);  // never across the stance foot
}

}  // namespace
}  // namespace stagger::engine
