#include "sim/experiment/limits.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "sim/experiment/trial_ceiling.h"
#include "tests/sim/kasaei.h"

namespace stagger::sim {
namespace {

LimitsSpec spec_with(std::vector<LimitCell> cells, std::vector<double> rungs) {
  LimitsSpec spec;
  spec.trial.robot = "kasaei";
  spec.trial.plant = PlantKind::lipm;
  spec.trial.observe_s = 6.0;
  spec.cells = std::move(cells);
  spec.rungs = std::move(rungs);
  spec.seeds = {1};
  return spec;
}

engine::Strategies strategies(bool step, bool time) {
  return {.ankle = true, .hip = false, .step = step, .time = time};
}

/// Trials of which only the seed and the impulse count.
LimitsRun fake(const std::function<bool(double dv, std::uint64_t seed)>& falls,
               std::atomic<int>* count = nullptr, bool alike = false) {
  LimitsRun run;
  run.threads = 3;
  run.trial = [=](const TrialSpec& trial) {
    if (count != nullptr) ++*count;
    const double dv = trial.push->impulse_ns / kasaei()->model.mass();
    TrialResult result;
    result.outcome = falls(dv, trial.seed) ? TrialOutcome::fell : TrialOutcome::recovered;
    result.recovery_time_s = 1.0;
    result.state_hash = alike ? 0 : trial.seed;
    return result;
  };
  return run;
}

TEST(Ladder, HasDecimalRungsAndBothEnds) {
  EXPECT_EQ(ladder(0.1, 0.3, 0.05), (std::vector<double>{0.1, 0.15, 0.2, 0.25, 0.3}));
  EXPECT_EQ(ladder(0.1, 0.29, 0.1), (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(ladder(0.5, 0.5, 0.1), (std::vector<double>{0.5}));
  EXPECT_TRUE(ladder(0.5, 0.4, 0.1).empty());
}

TEST(LimitVerdict, NeedsToBeUpAndBackInTime) {
  TrialResult result;
  result.outcome = TrialOutcome::recovered;
  result.recovery_time_s = 4.0;
  EXPECT_EQ(failure_of(result, 4.0), "");
  EXPECT_EQ(failure_of(result, 3.999), "not back within 3.999 s");
  result.recovery_time_s.reset();
  EXPECT_NE(failure_of(result, 4.0), "");
  for (const TrialOutcome outcome :
       {TrialOutcome::fell, TrialOutcome::timeout, TrialOutcome::invalid}) {
    result.outcome = outcome;
    result.recovery_time_s = 0.0;
    result.reason = "because";
    EXPECT_NE(failure_of(result, 4.0), "");
  }
}

TEST(LimitTrial, IsThePushOfItsRung) {
  LimitsSpec spec = spec_with({}, {});
  spec.trial.walk.vx = 0.2;
  spec.leg = Side::right;
  const TrialSpec walking = trial_of(spec, {180.0, 0.35, 0.1}, 0.5, 7, *kasaei());
  EXPECT_EQ(walking.seed, 7U);
  EXPECT_FALSE(walking.stand);
  EXPECT_EQ(walking.walk.vx, 0.2);
  EXPECT_EQ(walking.push->direction, Vec3(-1.0, 0.0, 0.0));
  EXPECT_NEAR(walking.push->impulse_ns, 15.0, 1e-9);
  EXPECT_EQ(walking.push->duration_s, 0.1);
  const auto phase = std::get<PhaseTrigger>(walking.push->trigger);
  EXPECT_EQ(phase.leg, Side::right);
  EXPECT_EQ(phase.fraction, 0.35);

  const TrialSpec standing = trial_of(spec, {90.0, {}, 0.01}, 0.5, 7, *kasaei());
  EXPECT_TRUE(standing.stand);
  EXPECT_EQ(standing.walk.vx, 0.0);
  EXPECT_TRUE(std::holds_alternative<Immediate>(standing.push->trigger));
}

TEST(LimitSearch, AHoleInTheLadderCounts) {
  LimitsSpec spec = spec_with({{0.0, 0.1, 0.01}}, {0.1, 0.2, 0.3, 0.4, 0.5});
  const auto limits =
      find_limits(spec, kasaei(), fake([](double dv, auto) { return std::abs(dv - 0.3) < 0.01; }));
  EXPECT_EQ(limits[0].pass_dv, 0.2);
  EXPECT_EQ(limits[0].fail_dv, 0.3);
}

TEST(LimitSearch, AllSeedsHaveToPass) {
  LimitsSpec spec = spec_with({{0.0, 0.1, 0.01}}, {0.1, 0.2, 0.3});
  spec.seeds = {11, 12, 13, 14, 15};
  const auto limits = find_limits(
      spec, kasaei(), fake([](double dv, auto seed) { return dv > 0.15 && seed >= 14; }));
  EXPECT_EQ(limits[0].pass_dv, 0.1);
  EXPECT_EQ(limits[0].fail_dv, 0.2);
  EXPECT_EQ(limits[0].fail_seed, 14U);
  EXPECT_FALSE(limits[0].seeds_alike);
}

TEST(LimitSearch, TellsWhenTheFirstRungFailsAndWhenNoneDoes) {
  LimitsSpec spec = spec_with({{0.0, 0.1, 0.01}}, {0.1, 0.2});
  const auto none = find_limits(spec, kasaei(), fake([](auto, auto) { return true; }))[0];
  EXPECT_FALSE(none.pass_dv);
  EXPECT_EQ(none.fail_dv, 0.1);
  const auto all = find_limits(spec, kasaei(), fake([](auto, auto) { return false; }))[0];
  EXPECT_EQ(all.pass_dv, 0.2);
  EXPECT_FALSE(all.fail_dv);
}

TEST(LimitSearch, RunsTwoSeedsWhereAllMoveAlike) {
  LimitsSpec spec = spec_with({{0.0, 0.1, 0.01}}, {0.1, 0.2, 0.3});
  spec.seeds = {1, 2, 3, 4, 5, 6};
  std::atomic<int> count = 0;
  const auto never = [](auto, auto) { return false; };
  EXPECT_TRUE(find_limits(spec, kasaei(), fake(never, &count, true))[0].seeds_alike);
  EXPECT_EQ(count.exchange(0), 6);
  EXPECT_FALSE(find_limits(spec, kasaei(), fake(never, &count, false))[0].seeds_alike);
  EXPECT_EQ(count, 18);
}

TEST(LimitSearch, TriesNoRungAboveTheFirstThatFails) {
  LimitsSpec spec = spec_with({{0.0, 0.1, 0.01}}, {0.1, 0.2, 0.3, 0.4});
  std::atomic<int> count = 0;
  find_limits(spec, kasaei(), fake([](double dv, auto) { return dv > 0.15; }, &count));
  EXPECT_EQ(count, 2);
}

TEST(LimitSearch, CountsDownToNothingAndStopsWhenItIsTold) {
  LimitsSpec spec = spec_with({{0.0, 0.1, 0.01}, {90.0, 0.1, 0.01}}, {0.1, 0.2, 0.3});
  spec.seeds = {1, 2, 3};
  LimitsRun run = fake([](auto, auto) { return false; });
  LimitsProgress last;
  run.watch = [&](const LimitsProgress& progress) {
    EXPECT_EQ(progress.trials, last.trials + 1);
    last = progress;
    EXPECT_EQ(progress.trials + progress.left, 18U);
    return true;
  };
  find_limits(spec, kasaei(), run);
  EXPECT_EQ(last.trials, 18U);
  EXPECT_EQ(last.left, 0U);
  run.watch = [](const LimitsProgress& progress) { return progress.trials < 4; };
  EXPECT_THROW(find_limits(spec, kasaei(), run), LimitsStopped);
}

TEST(LimitsLipm, LieWithinOneRungOfTheCeiling) {
  // Without the step's time the engine does all that can be done, but for some percent.
  constexpr double rung = 0.05;
  for (const bool step : {false, true}) {
    LimitsSpec spec = spec_with({{0.0, 0.1, 0.01}, {90.0, 0.1, 0.01}, {270.0, 0.35, 0.01}}, {});
    if (!step) spec.cells.push_back({45.0, {}, 0.01});
    spec.trial.strategies = strategies(step, false);
    spec.rungs = ladder(0.04, 1.7, rung);
    for (const Limit& limit : find_limits(spec, kasaei())) {
      EXPECT_LE(limit.pass_dv.value(), limit.ceiling_dv.value()) << limit.cell.direction_deg;
      EXPECT_GE(limit.pass_dv.value(), limit.ceiling_dv.value() - rung) << limit.cell.direction_deg;
    }
  }
}

TEST(LimitsLipm, EachStrategyAddsToTheOneBefore) {
  double before = 0.0;
  double ceiling_before = 0.0;
  for (const engine::Strategies& allowed :
       {strategies(false, false), strategies(true, false), strategies(true, true)}) {
    LimitsSpec spec = spec_with({{0.0, 0.1, 0.01}}, ladder(0.1, 2.5, 0.1));
    spec.trial.strategies = allowed;
    const Limit limit = find_limits(spec, kasaei())[0];
    EXPECT_GT(limit.pass_dv.value(), before + 0.15);
    EXPECT_GT(limit.ceiling_dv.value(), ceiling_before + 0.15);
    EXPECT_LE(limit.pass_dv.value(), limit.ceiling_dv.value());
    before = *limit.pass_dv;
    ceiling_before = *limit.ceiling_dv;
  }
}

TEST(LimitsLipm, AreTheSameForAnyNumberOfThreads) {
  const auto found = [](unsigned threads) {
    LimitsSpec spec =
        spec_with({{0.0, 0.1, 0.01}, {90.0, 0.35, 0.1}, {180.0, {}, 0.01}}, ladder(0.2, 0.8, 0.2));
    spec.seeds = {1, 2, 3};
    LimitsRun run;
    run.threads = threads;
    return find_limits(spec, kasaei(), run);
  };
  const auto one = found(1);
  const auto five = found(5);
  ASSERT_EQ(one.size(), five.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].cell.direction_deg, five[i].cell.direction_deg);
    EXPECT_EQ(one[i].pass_dv, five[i].pass_dv);
    EXPECT_EQ(one[i].fail_dv, five[i].fail_dv);
    EXPECT_EQ(one[i].fail_reason, five[i].fail_reason);
    EXPECT_EQ(one[i].seeds_alike, five[i].seeds_alike);
  }
}

TEST(LimitsLipm, TheLegsAreMirrorImages) {
  const auto limit = [](Side leg, double direction) {
    LimitsSpec spec = spec_with({{direction, 0.35, 0.01}}, ladder(0.1, 1.5, 0.1));
    spec.leg = leg;
    return find_limits(spec, kasaei())[0];
  };
  const Limit left = limit(Side::left, 60.0);
  const Limit right = limit(Side::right, 300.0);
  EXPECT_EQ(left.pass_dv, right.pass_dv);
  EXPECT_NEAR(left.ceiling_dv.value(), right.ceiling_dv.value(), 1e-9);
}

}  // namespace
}  // namespace stagger::sim
