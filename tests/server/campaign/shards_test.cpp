#include "server/campaign/shards.h"

#include <gmock/gmock.h>

#include <fstream>

#include "server/shell_word.h"
#include "tests/server/campaign/campaign_fixture.h"

namespace stagger::server::campaign {
namespace {

class ShardsTest : public CampaignFixture {
 protected:
  void begin(const nlohmann::json& spec) {
    plan = plan_of(spec);
    parts.emplace(folder / "parts");
    parts->create(spec.dump(), Store::Journal::rollback);
  }
  std::uint64_t run(const Shard& shard, const std::string& attempt = "1-0") {
    return run_shard(*parts, *plan, shard, attempt, options_of(limit).runner);
  }
  Merged merge() {
    Store store(parts->store(), Store::Access::write);
    return merge_shards(*parts, store);
  }
  std::uint64_t pending() const {
    return pending_trials(*plan, Store(parts->store(), Store::Access::read)).size();
  }
  std::uint64_t parts_hash() const {
    return results_hash(Store(parts->store(), Store::Access::read));
  }
  std::uint64_t whole_hash() {
    Store store = store_of("whole", plan->spec().name);
    run_campaign(*plan, store, options_of(limit));
    return results_hash(store);
  }
  double limit = 9.5;
  std::unique_ptr<Plan> plan;
  std::optional<Folder> parts;
};

TEST_F(ShardsTest, PartsMakeTheWhole) {
  begin(grid());
  EXPECT_EQ(pending(), 12U);
  for (const std::uint64_t index : {2U, 0U, 1U}) EXPECT_EQ(run({1, index, 3}), 0U);
  EXPECT_EQ(merge().fresh, 12U);
  EXPECT_EQ(pending(), 0U);
  EXPECT_EQ(parts_hash(), whole_hash());
}

TEST_F(ShardsTest, ABisectionGoesInRounds) {
  begin(bisection(1.0));
  std::uint64_t round = 0;
  while (pending() > 0 && round < 20) {
    ++round;
    run({round, 0, 2});
    run({round, 1, 2});
    EXPECT_GT(merge().fresh, 0U);
  }
  EXPECT_GT(round, 2U);
  EXPECT_EQ(parts_hash(), whole_hash());
}

TEST_F(ShardsTest, ASecondAttemptTakesOverTheFirstOnesTrials) {
  begin(grid());
  RunnerOptions few = options_of(limit, 1).runner;
  int left = 3;
  few.stop = [&left] { return left-- == 0; };
  EXPECT_EQ(run_shard(*parts, *plan, {1, 0, 1}, "7-0", few), 9U);
  int run_again = 0;
  RunnerOptions rest = options_of(limit, 1).runner;
  rest.stored = [&run_again](const Record&) { ++run_again; };
  EXPECT_EQ(run_shard(*parts, *plan, {1, 0, 1}, "7-1", rest), 0U);
  EXPECT_EQ(run_again, 9);
  EXPECT_EQ(shard_files(*parts).size(), 2U);
  EXPECT_EQ(merge().fresh, 12U);  // and not 15
  EXPECT_EQ(parts_hash(), whole_hash());
}

TEST_F(ShardsTest, AMissingShardIsPendingAgain) {
  begin(grid());
  run({1, 0, 3});
  EXPECT_EQ(trials_under_way(*parts, Store(parts->store(), Store::Access::read)), 4U);
  EXPECT_EQ(merge().fresh, 4U);
  EXPECT_EQ(trials_under_way(*parts, Store(parts->store(), Store::Access::read)), 0U);
  EXPECT_EQ(pending(), 8U);
  EXPECT_EQ(run({2, 0, 1}), 0U);
  EXPECT_EQ(merge().fresh, 8U);
  EXPECT_EQ(merge().fresh, 0U);
  EXPECT_EQ(parts_hash(), whole_hash());
}

TEST_F(ShardsTest, DifferentResultsOfOneTrialAreNotMerged) {
  begin(grid());
  run({1, 0, 1}, "1-0");
  limit = 3.0;
  std::filesystem::rename(shard_file(*parts, {1, 0, 1}, "1-0"), folder / "aside");
  run({1, 0, 1}, "2-0");
  std::filesystem::rename(folder / "aside", shard_file(*parts, {1, 0, 1}, "1-0"));
  EXPECT_THROW(merge(), std::runtime_error);
}

TEST_F(ShardsTest, AFileThatCannotBeReadIsTold) {
  begin(grid());
  run({1, 0, 2});
  std::ofstream(shard_file(*parts, {1, 1, 2}, "1-0")) << "no database, for longer than a header";
  const Merged merged = merge();
  EXPECT_EQ(merged.fresh, 6U);
  EXPECT_EQ(merged.unreadable.size(), 1U);
  EXPECT_EQ(pending(), 6U);
}

TEST(ShellWord, IsOneWordWhateverItHolds) {
  EXPECT_EQ(shell_word("a/b-1.json"), "a/b-1.json");
  EXPECT_EQ(shell_word("my file"), "'my file'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("--round"), "--round");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace stagger::server::campaign
