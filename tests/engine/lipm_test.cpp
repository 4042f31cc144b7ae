#include "engine/lipm.h"

#include <gtest/gtest.h>

#include "tests/engine/integrate.h"
#include "tests/engine/omega.h"

namespace stagger::engine {
namespace {

TEST(Lipm, MovingZmpAgreesWithNumericalIntegration) {
  const ZmpSegment segment{0.7, {0.1, -0.2}, {0.5, 0.1}};
  const Vec2 com(0.05, -0.1);
  const Vec2 dcm_end(0.62, 0.14);
  const Vec2 dcm_start = dcm_before(segment, dcm_end, 0.0, omega);
  testing::PointMass start{com, omega * (dcm_start - com)};
  for (const double tau : {0.1, 0.35, 0.7}) {
    const auto state = testing::integrate(
        start, [&](double t) { return segment.zmp(t); }, tau, omega, 2000);
    EXPECT_LT((state.com - com_after(segment, com, dcm_start, tau, omega)).norm(), 1e-11) << tau;
    EXPECT_LT((state.dcm(omega) - dcm_before(segment, dcm_end, tau, omega)).norm(), 1e-11) << tau;
  }
}

TEST(Lipm, SegmentOfNoDurationIsAStep) {
  const ZmpSegment segment{0.0, {0.0, 0.1}, {0.0, -0.1}};
  const Vec2 dcm(0.02, 0.03);
  EXPECT_EQ(dcm_before(segment, dcm, 0.0, omega), dcm);
  EXPECT_EQ(segment.velocity(), Vec2::Zero());
  EXPECT_EQ(segment.zmp(0.0), Vec2(0.0, -0.1));
  const Vec2 com(0.01, -0.02);
  EXPECT_LT((com_after(segment, com, dcm, 0.0, omega) - com).norm(), 1e-15);
}

TEST(Lipm, TransferFactorIsContinuousAtZero) {
  EXPECT_DOUBLE_EQ(transfer_factor(0.0, omega), 1.0);
  EXPECT_NEAR(transfer_factor(1e-8, omega), 1.0, 1e-7);
  EXPECT_NEAR(transfer_factor(0.2, omega), (1.0 - std::exp(-0.2 * omega)) / (0.2 * omega), 1e-15);
}

TEST(Lipm, DiscretisationIsTheExactResponseToAHeldZmp) {
  const double dt = 0.002;
  const DiscreteLipm lipm = discretise(omega, dt);
  const Vec2 com(0.03, -0.01);
  const Vec2 dcm(0.08, 0.04);
  const Vec2 zmp(0.01, 0.02);
  const ZmpSegment held{dt, zmp, zmp};
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d next =
        lipm.a * Eigen::Vector2d(com[axis], dcm[axis]) + lipm.b * zmp[axis];
    EXPECT_NEAR(next[0], com_after(held, com, dcm, dt, omega)[axis], 1e-15);
    EXPECT_NEAR(next[1], dcm_after(dcm, zmp, dt, omega)[axis], 1e-15);
  }
}

}  // namespace
}  // namespace stagger::engine
