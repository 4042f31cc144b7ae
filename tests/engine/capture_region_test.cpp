#include "engine/capture_region.h"

#include <gtest/gtest.h>

#include "engine/capturability.h"
#include "engine/dcm_goal.h"
#include "engine/lipm.h"
#include "tests/engine/omega.h"

namespace stagger::engine {
namespace {

StepAbility paper_robot() {
  StepAbility ability;
  ability.omega = omega;
  ability.sole = {{-0.075, -0.0375}, {0.075, -0.0375}, {0.075, 0.0375}, {-0.075, 0.0375}};
  ability.reach = {{-0.95, -0.6}, {0.95, -0.6}, {0.95, -0.1}, {-0.95, -0.1}};
  return ability;
}

double forward_end(const ConvexSet& set) {
  double most = 0.0;
  for (const Vec2& p : set) most = std::max(most, p.x());
  return most;
}

// d = h + (l + (d - h) e^{-w Tds}) e^{-w Tss}: ever so many of the longest steps.
TEST(Capturability, AgreesWithTheGeometricSeriesStraightAhead) {
  const StepAbility ability = paper_robot();
  const double h = 0.075;
  const double l = 0.95;
  double d = h;
  for (int i = 0; i < 60; ++i)
    d = h + (l + (d - h) * std::exp(-omega * 0.2)) * std::exp(-omega * 0.8);
  EXPECT_NEAR(forward_end(viable_dcm(ability)), d, 1e-8);
}

TEST(Capturability, StepsThatStayAsPlannedLeaveTheSoleAlone) {
  StepAbility ability = paper_robot();
  ability.reach = {{0.0, -0.2}};
  EXPECT_NEAR(forward_end(viable_dcm(ability)), 0.075, 1e-8);
}

TEST(Capturability, FreedomOfTimeTakesNothingAway) {
  const ConvexSet fixed = viable_dcm(paper_robot());
  StepAbility ability = paper_robot();
  ability.sooner = ability.later = 0.2;
  const ConvexSet free = viable_dcm(ability);
  for (const Vec2& corner : fixed) EXPECT_GE(margin(free, corner), -1e-8);
  EXPECT_GT(forward_end(free), forward_end(fixed) + 0.05);
}

/// The best that ZMPs and footholds of a grid do for a DCM at lift-off: how far inside the viable
/// region it is at the next lift-off [m].
double best_after_one_step(const StepAbility& ability, const ConvexSet& viable, const Vec2& dcm) {
  const double single = std::exp(omega * ability.t_ss);
  const double both = std::exp(omega * ability.t_ds);
  const ConvexSet next = mirrored(viable);
  double best = -1e300;
  for (double zx = -0.075; zx < 0.076; zx += 0.025) {
    for (double zy = -0.0375; zy < 0.038; zy += 0.0125) {
      const Vec2 zmp(zx, zy);
      const Vec2 touchdown = zmp + (dcm - zmp) * single;
      for (double fx = -0.95; fx < 0.96; fx += 0.05) {
        for (double fy = -0.6; fy < -0.09; fy += 0.05) {
          const Vec2 foot(fx, fy);
          for (const Vec2& edge : ability.sole) {
            for (const double along : {0.0, 0.5, 1.0}) {
              const Vec2 held = along * foot + edge;
              const Vec2 lift_off = held + (touchdown - held) * both - foot;
              best = std::max(best, margin(next, lift_off));
            }
          }
        }
      }
    }
  }
  return best;
}

TEST(Capturability, InsideSomeChoiceStaysInsideAndOutsideNoneDoes) {
  const StepAbility ability = paper_robot();
  const ConvexSet viable = viable_dcm(ability);
  for (double angle = 0.05; angle < 6.28; angle += 0.6) {
    const Vec2 direction(std::cos(angle), std::sin(angle));
    const double edge = ray_exit(viable, direction);
    ASSERT_GT(edge, 0.0);
    EXPECT_GT(best_after_one_step(ability, viable, 0.97 * edge * direction), 0.0) << angle;
    EXPECT_LT(best_after_one_step(ability, viable, 1.01 * edge * direction), 0.0) << angle;
  }
}

TEST(CaptureRegion, LiesWithinTheViableOneAndKeepsSomeOfTheSole) {
  Parameters parameters;
  const CaptureRegion region(parameters, ReachRegion(parameters));
  const ConvexSet viable = viable_dcm(paper_robot());
  const ConvexPolygon& left = region.polygon(Side::left, false);
  ASSERT_GE(left.size(), 4U);
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_GE(margin(viable, left.vertex(i)), 1e-3);
    EXPECT_LE(margin(viable, left.vertex(i)), 0.02);
  }
  const ConvexPolygon& right = region.polygon(Side::right, false);
  EXPECT_NEAR(left.margin({0.02, 0.01}), right.margin({0.02, -0.01}), 1e-12);
}

TEST(CaptureRegion, FreeStepTimesMakeItLarger) {
  const Parameters parameters;
  const CaptureRegion region(parameters, ReachRegion(parameters));
  const ConvexPolygon& nominal = region.polygon(Side::left, false);
  const ConvexPolygon& free = region.polygon(Side::left, true);
  // Down from twelve corners to eight it loses less than half a millimetre.
  for (std::size_t i = 0; i < nominal.size(); ++i) EXPECT_GE(free.margin(nominal.vertex(i)), -5e-4);
  EXPECT_LT(nominal.margin({0.2, 0.0}), 0.0);
  EXPECT_GT(free.margin({0.2, 0.0}), 0.0);
}

// Steps as short as the limit of their time: no step is reckoned to last no time.
TEST(CaptureRegion, ShortStepsKeepTheirLeastTime) {
  Parameters parameters;
  parameters.t_ss = 0.2;
  parameters.t_ds = 0.0;
  const StepAbility ability = step_ability(parameters, ReachRegion(parameters), true);
  EXPECT_NEAR(ability.t_ss - ability.sooner, parameters.least_t_ss, 1e-12);
  // d = h + l e^{-w T} / (1 - e^{-w T}) with the shortest steps.
  const double g = std::exp(-omega * parameters.least_t_ss);
  EXPECT_NEAR(forward_end(viable_dcm(ability)), 0.075 + 0.95 * g / (1.0 - g), 1e-6);
}

TEST(Capturability, RefusesStepsThatLastNoTime) {
  StepAbility ability = paper_robot();
  ability.t_ds = 0.0;
  ability.sooner = ability.t_ss;
  EXPECT_THROW(viable_dcm(ability), std::invalid_argument);
}

class ZmpTowards : public ::testing::Test {
 protected:
  DcmGoal goal() const { return {&region_, {0.4, -0.2}, 0.0, std::exp(omega * 0.2), {}}; }
  /// How far outside its goal the DCM ends up [m].
  double miss(const Vec2& zmp, const Vec2& dcm) const {
    const Vec2 then = zmp + (dcm - zmp) * goal().growth - goal().origin;
    return (then - region_.clamp(then)).norm();
  }
  ConvexPolygon region_{
      std::array<Vec2, 4>{Vec2(-0.1, -0.03), Vec2(0.1, -0.03), Vec2(0.1, 0.08), Vec2(-0.1, 0.08)}};
  /// Hull of two feet that stand askew.
  ConvexPolygon support_{std::array<Vec2, 6>{Vec2(-0.07, -0.03), Vec2(-0.07, 0.03),
                                             Vec2(0.07, 0.03), Vec2(0.33, -0.23), Vec2(0.47, -0.23),
                                             Vec2(0.47, -0.17)}};
};

TEST_F(ZmpTowards, IsTheWantedOneWhereThatWillDo) {
  const Vec2 wanted(0.2, -0.1);
  const Vec2 dcm = wanted + (goal().origin - wanted) / goal().growth;
  EXPECT_EQ(zmp_towards(goal(), wanted, dcm, support_), wanted);
}

TEST_F(ZmpTowards, WithoutAGoalIsTheWantedOne) {
  EXPECT_EQ(zmp_towards({}, {0.1, 0.0}, {5.0, 5.0}, support_), Vec2(0.1, 0.0));
}

TEST_F(ZmpTowards, MissesByAsLittleAsAnyZmpOfAFineGrid) {
  for (double x = 0.1; x < 0.6; x += 0.07) {
    for (double y = -0.4; y < 0.1; y += 0.06) {
      const Vec2 dcm(x, y);
      const Vec2 zmp = zmp_towards(goal(), support_.clamp({x, y}), dcm, support_);
      EXPECT_GE(support_.margin(zmp), -1e-12);
      double least = 1e300;
      for (double px = -0.1; px < 0.5; px += 0.01) {
        for (double py = -0.25; py < 0.05; py += 0.01) {
          const Vec2 tried = support_.clamp({px, py});
          least = std::min(least, miss(tried, dcm));
        }
      }
      EXPECT_LE(miss(zmp, dcm), least + 2e-3) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace stagger::engine
