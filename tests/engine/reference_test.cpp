#include "engine/reference.h"

#include <gtest/gtest.h>

#include "tests/engine/integrate.h"
#include "tests/engine/omega.h"

namespace stagger::engine {
namespace {

// The paper's plan: six steps of 0.5 m, 0.8 s + 0.2 s, from f_0 = 0 to f_6 = 3 m. Expected nodes:
// an independent solution of the boundary value problem, given to 1e-5 m.
TEST(Reference, NodesOfThePapersPlan) {
  DcmPlan plan;
  for (int i = 0; i < 6; ++i) {
    const Vec2 foot(0.5 * i, 0.5 * i);
    const Vec2 next(0.5 * (i + 1), 0.5 * (i + 1));
    plan.add({0.8, foot, foot});
    plan.add({0.2, foot, next});
  }
  plan.add({0.8, Vec2(3.0, 3.0), Vec2(3.0, 3.0)});
  plan.solve({3.0, 3.0}, omega);
  EXPECT_NEAR(plan.dcm().x(), 0.03171, 1e-5);
  EXPECT_NEAR(plan.dcm_at_end(0).x(), 0.38850, 1e-5);
  EXPECT_NEAR(plan.dcm_at_end(1).x(), 0.53171, 1e-5);
  EXPECT_NEAR(plan.dcm_at_end(10).x(), 2.87156, 1e-5);
  EXPECT_NEAR(plan.dcm_at_end(11).x(), 3.0, 1e-12);

  // CoM nodes, over the boundaries in one go and tick by tick.
  Vec2 com = Vec2::Zero();
  EXPECT_NEAR(plan.advance_com(com, 0.8, omega).x(), 0.19296, 1e-5);
  EXPECT_NEAR(plan.advance_com(com, 1.0, omega).x(), 0.32939, 1e-5);
  EXPECT_NEAR(plan.advance_com(com, 1.8, omega).x(), 0.67903, 1e-5);
  EXPECT_NEAR(plan.advance_com(com, 6.0, omega).x(), 2.80575, 1e-5);
  EXPECT_NEAR(plan.advance_com(com, 6.8, omega).x(), 2.98415, 1e-5);
}

TEST(Reference, PeriodicOffsetOfTheSteadyGait) {
  const Vec2 step(0.5, 0.0);
  EXPECT_NEAR(periodic_dcm_offset(step, step, 0.8, 0.2, omega).x(), 0.031710, 1e-6);
  EXPECT_NEAR(periodic_dcm_offset(step, step, 1.0, 0.0, omega).x(), 0.022808, 1e-6);
  // Stepping in place, feet 0.2 m apart: the DCM leans 1.16 cm towards the swing foot.
  EXPECT_NEAR(periodic_dcm_offset({0.0, -0.2}, {0.0, 0.2}, 0.8, 0.2, omega).y(), -0.0116, 5e-5);
}

TEST(Reference, InitializeStartsFromRest) {
  const Vec2 stance(0.0, 0.1);
  const Vec2 dcm_end(0.0, 0.06);
  const Vec2 rest = Vec2::Zero();
  const double duration = 0.6;
  const Vec2 start = initial_zmp(rest, stance, dcm_end, duration, omega);
  const auto state = testing::integrate(
      {rest, Vec2::Zero()}, [&](double t) { return start + (stance - start) * (t / duration); },
      duration, omega, 2000);
  EXPECT_LT((state.dcm(omega) - dcm_end).norm(), 1e-10);
}

TEST(Reference, ComVelocityIsContinuousOverSegments) {
  DcmPlan plan;
  plan.add({0.4, {0.0, 0.1}, {0.0, 0.1}});
  plan.add({0.1, {0.0, 0.1}, {0.3, -0.1}});
  plan.add({0.4, {0.3, -0.1}, {0.3, -0.1}});
  plan.solve({0.33, -0.06}, omega);
  const Vec2 com(-0.05, 0.03);
  const double h = 1e-5;
  for (const double boundary : {0.4, 0.5}) {
    const Vec2 before =
        plan.advance_com(com, boundary, omega) - plan.advance_com(com, boundary - h, omega);
    const Vec2 after =
        plan.advance_com(com, boundary + h, omega) - plan.advance_com(com, boundary, omega);
    EXPECT_LT((after - before).norm() / h, 1e-3);  // one acceleration times h, no jump
  }
}

}  // namespace
}  // namespace stagger::engine
