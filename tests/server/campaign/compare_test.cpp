#include "server/campaign/compare.h"

#include <gtest/gtest.h>

#include "tests/server/campaign/campaign_fixture.h"

namespace stagger::server::campaign {
namespace {

class CompareTest : public CampaignFixture {
 protected:
  /// Two runs whose robots fall from pushes of these impulses on [N s].
  CampaignComparison compared(const nlohmann::json& spec, double limit_a, double limit_b,
                              const Tolerance& tolerance = {}) {
    const auto plan = plan_of(spec);
    const std::string name = std::to_string(runs_++);
    Store a = store_of(name + "a");
    Store b = store_of(name + "b");
    run_campaign(*plan, a, options_of(limit_a));
    run_campaign(*plan, b, options_of(limit_b));
    return compare(*plan, a, *plan, b, tolerance);
  }

 private:
  int runs_ = 0;
};

TEST_F(CompareTest, TheSameIsNotWorse) {
  const auto same = compared(grid(), 5.0, 5.0);
  EXPECT_EQ(same.pairs, 12U);
  EXPECT_EQ(same.only_a + same.only_b, 0U);
  EXPECT_TRUE(same.regressions.empty());
  EXPECT_TRUE(same.worse.empty());
  EXPECT_EQ(same.groups.front().difference->value, 0.0);
}

TEST_F(CompareTest, WorseNamesTheTrialsAndTheGroups) {
  const auto worse = compared(grid(), 5.0, 3.0);
  EXPECT_EQ(worse.worse.size(), 4U);
  EXPECT_NEAR(worse.groups.front().difference->value, 4.0 / 12.0, 1e-12);
  ASSERT_FALSE(worse.regressions.empty());
  EXPECT_TRUE(worse.regressions.front().starts_with("all trials"));
  // Only those that pass in both are measured.
  EXPECT_EQ(worse.measures.front().pairs, 4U);
  EXPECT_EQ(worse.measures.front().difference->value, 0.0);
}

TEST_F(CompareTest, BetterIsNoRegressionAndATolerableLossNeither) {
  EXPECT_TRUE(compared(grid(), 3.0, 5.0).regressions.empty());
  EXPECT_TRUE(compared(grid(), 5.0, 3.0, {.failures = 0.4}).regressions.empty());
}

TEST_F(CompareTest, OneGroupCanBeWorseWhileTheWholeIsTolerable) {
  auto spec = grid();
  spec["design"]["repeats"] = 40;
  const auto worse = compared(spec, 5.0, 3.0, {.failures = 0.4});
  ASSERT_EQ(worse.regressions.size(), 1U);
  EXPECT_TRUE(worse.regressions.front().starts_with("push.impulse_ns = 4"));
}

TEST_F(CompareTest, LimitsAreComparedByDirection) {
  const auto worse = compared(bisection(1.0), 20.5, 10.5, {.failures = 1.0});
  ASSERT_EQ(worse.limits.size(), 2U);
  EXPECT_EQ(worse.limits[0].a, 20.0);
  EXPECT_EQ(worse.limits[0].b, 10.0);
  EXPECT_NEAR(worse.limit_change->value, -0.5, 1e-12);
  ASSERT_EQ(worse.regressions.size(), 1U);
  EXPECT_TRUE(
      compared(bisection(1.0), 20.5, 10.5, {.failures = 1.0, .limit = 0.6}).regressions.empty());
}

TEST_F(CompareTest, TrialsWithoutPartnerDoNotCount) {
  const auto plan_a = plan_of(grid());
  auto spec = grid();
  spec["factors"]["push.direction_deg"] = {0, 45};
  const auto plan_b = plan_of(spec);
  Store a = store_of("a");
  Store b = store_of("b");
  run_campaign(*plan_a, a, options_of(5.0));
  run_campaign(*plan_b, b, options_of(5.0));
  const auto compared = compare(*plan_a, a, *plan_b, b, {});
  EXPECT_EQ(compared.pairs, 6U);
  EXPECT_EQ(compared.only_a, 6U);
  EXPECT_EQ(compared.only_b, 6U);
}

}  // namespace
}  // namespace stagger::server::campaign
