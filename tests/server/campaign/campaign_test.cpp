#include "server/campaign/campaign.h"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <mutex>

#include "server/campaign/summary.h"
#include "tests/server/campaign/campaign_fixture.h"

namespace stagger::server::campaign {
namespace {

class CampaignTest : public CampaignFixture {};

TEST_F(CampaignTest, LipmResultsAreTheSameWhateverTheWorkersAndHoweverOftenItStops) {
  const auto plan = plan_of(grid());
  Store whole = store_of("whole");
  CampaignOptions one;
  one.runner.threads = 1;
  EXPECT_EQ(run_campaign(*plan, whole, one), End::complete);
  EXPECT_EQ(whole.count(), 12U);
  EXPECT_GE(whole.counts().twice, 1U);

  Store pieces = store_of("pieces");
  for (std::uint64_t stop = 1; stop < 12; stop += 4) {
    CampaignOptions some;
    some.runner.threads = 3;
    some.runner.stop = [&] { return pieces.count() >= stop; };
    EXPECT_EQ(run_campaign(*plan, pieces, some), End::stopped);
    EXPECT_LT(pieces.count(), 12U);
  }
  EXPECT_EQ(run_campaign(*plan, pieces), End::complete);
  EXPECT_EQ(results_hash(pieces), results_hash(whole));
}

TEST_F(CampaignTest, EachTrialIsRunOnceAndTheGuardsTwice) {
  auto spec = grid();
  spec["design"]["repeats"] = 50;
  const auto plan = plan_of(spec);
  Store store = store_of("a");
  std::mutex mutex;
  std::map<std::uint64_t, int> runs;
  auto options = options_of(5.0, 4);
  options.runner.trial = [&](const sim::TrialSpec& trial) {
    const std::lock_guard lock(mutex);
    ++runs[trial.seed];
    return made_up(trial, 5.0);
  };
  EXPECT_EQ(run_campaign(*plan, store, options), End::complete);
  ASSERT_EQ(runs.size(), 300U);
  for (std::uint64_t number = 0; number < 300; ++number) {
    const PlannedTrial trial = plan->trial(number);
    EXPECT_EQ(runs[trial.spec.seed], trial.twice ? 2 : 1) << number;
  }
  EXPECT_EQ(run_campaign(*plan, store, options), End::complete);
  EXPECT_EQ(runs[plan->trial(0).spec.seed], 2) << "run again though it was known";
}

TEST_F(CampaignTest, BisectionOfManyWorkersIsThatOfOne) {
  const auto plan = plan_of(bisection(0.5));
  std::uint64_t hash = 0;
  for (const unsigned threads : {1U, 4U}) {
    Store store = store_of(std::to_string(threads));
    EXPECT_EQ(run_campaign(*plan, store, options_of(13.2, threads)), End::complete);
    const Summary summary = summarize(*plan, store);
    ASSERT_EQ(summary.limits.size(), 2U);
    EXPECT_EQ(summary.limits[1].pass, 13.0);
    EXPECT_EQ(summary.limits[1].fail, 13.5);
    EXPECT_NEAR(summary.limits[1].at_pass->delta_v, 13.0 / 30.0, 1e-9);
    EXPECT_EQ(summary.state, State::complete);
    if (hash != 0) {
      EXPECT_EQ(results_hash(store), hash);
    }
    hash = results_hash(store);
  }
}

TEST_F(CampaignTest, ATrialThatDoesNotRepeatEndsItAndMakesItInvalid) {
  const auto plan = plan_of(grid());
  Store store = store_of("a");
  auto options = options_of(5.0);
  std::atomic<std::uint64_t> clock{0};
  options.runner.trial = [&](const sim::TrialSpec& trial) {
    auto result = made_up(trial, 5.0);
    result.state_hash += clock++;
    return result;
  };
  EXPECT_EQ(run_campaign(*plan, store, options), End::mismatch);
  const Summary summary = summarize(*plan, store);
  EXPECT_EQ(summary.state, State::invalid);
  EXPECT_EQ(summary.mismatches, std::vector<std::uint64_t>{0});
  // It stays so.
  EXPECT_EQ(run_campaign(*plan, store, options_of(5.0)), End::mismatch);
}

TEST_F(CampaignTest, AThresholdCanEndIt) {
  auto spec = grid();
  spec["design"]["repeats"] = 50;
  spec["thresholds"] = {{{"expr", "fall_rate == 0 where push.impulse_ns >= 4"}, {"abort", true}}};
  const auto plan = plan_of(spec);
  Store store = store_of("a");
  EXPECT_EQ(run_campaign(*plan, store, options_of(1.0)), End::aborted);
  EXPECT_LT(store.count(), 300U);
  Store passing = store_of("b");
  EXPECT_EQ(run_campaign(*plan, passing, options_of(100.0)), End::complete);
}

TEST_F(CampaignTest, AnExceptionOfATrialComesThrough) {
  const auto plan = plan_of(grid());
  Store store = store_of("a");
  auto options = options_of(5.0, 3);
  options.runner.trial = [](const sim::TrialSpec&) -> sim::TrialResult {
    throw std::runtime_error("no world");
  };
  EXPECT_THROW(run_campaign(*plan, store, options), std::runtime_error);
}

TEST_F(CampaignTest, WhatCannotBeRunIsInvalidAndNoFall) {
  auto spec = grid();
  spec["factors"]["push.direction_deg"] = {0, 400};
  const auto plan = plan_of(spec);
  Store store = store_of("a");
  EXPECT_EQ(run_campaign(*plan, store, options_of(100.0)), End::complete);
  EXPECT_EQ(store.counts().invalid, 6U);
  EXPECT_EQ(summarize(*plan, store).counts.fell, 0U);
}

TEST_F(CampaignTest, ARobotThatCameBackTooLateDoesNotPass) {
  auto spec = grid();
  spec["pass"] = {{"recover_within_s", 0.4}};
  const auto plan = plan_of(spec);
  Store store = store_of("a");
  run_campaign(*plan, store, options_of(100.0));
  EXPECT_EQ(store.counts().recovered, 12U);
  EXPECT_EQ(store.counts().passed, 0U);
}

TEST_F(CampaignTest, LipmChangesAreNoticed) {
  const auto plan = plan_of(grid());
  Store store = store_of("a");
  run_campaign(*plan, store);
  EXPECT_TRUE(changed_trials(*plan, store).empty());
  Store other = store_of("b");
  run_campaign(*plan, other, options_of(5.0));
  EXPECT_EQ(changed_trials(*plan, other), std::vector<std::uint64_t>{0});
}

TEST_F(CampaignTest, SummaryJudgesThresholds) {
  auto spec = grid();
  spec["thresholds"] = {"fall_rate == 0 where push.impulse_ns <= 4",
                        "fall_rate == 0",
                        "falls == 4",
                        "trials == 2 where push.direction_deg == 90 and push.delta_v > 0.19",
                        "max(steps_to_recover) < 4",
                        "pass_rate > 0.6 where robot == kasaei",
                        "fall_rate == 0 where repeat > 7"};
  const auto plan = plan_of(spec);
  Store store = store_of("a");
  run_campaign(*plan, store, options_of(5.0));
  const Summary summary = summarize(*plan, store);
  std::vector<bool> passed;
  for (const auto& result : summary.thresholds) passed.push_back(result.passed);
  EXPECT_EQ(passed, (std::vector<bool>{true, false, true, true, true, true, false}));
  EXPECT_NEAR(*summary.thresholds[1].value, 1.0 / 3.0, 1e-12);
  // No trial is no reason to pass.
  EXPECT_FALSE(summary.thresholds[6].value);
  EXPECT_FALSE(summary.thresholds_passed());
  ASSERT_EQ(summary.groups.size(), 5U);
  EXPECT_EQ(summary.groups[0].counts.trials, 6U);
}

TEST_F(CampaignTest, LimitsThatAreNotKnownPassNothing) {
  auto spec = bisection(1.0);
  spec["thresholds"] = {"min(limit_ns) >= 10", "min(limit) >= 10 where push.direction_deg == 90",
                        "min(limit_percent) >= 0"};
  const auto plan = plan_of(spec);
  const auto passed = [&](const Store& store) {
    std::vector<bool> all;
    for (const auto& result : summarize(*plan, store).thresholds) all.push_back(result.passed);
    return all;
  };
  Store store = store_of("a");
  EXPECT_EQ(passed(store), (std::vector<bool>{false, false, false}));
  run_campaign(*plan, store, options_of(12.5));
  // The push starts at once, for which no ceiling is known.
  EXPECT_EQ(passed(store), (std::vector<bool>{true, true, false}));
  Store weak = store_of("b");
  run_campaign(*plan, weak, options_of(1.0));
  EXPECT_EQ(passed(weak)[0], false);
}

}  // namespace
}  // namespace stagger::server::campaign
