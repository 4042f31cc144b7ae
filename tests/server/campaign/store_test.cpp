#include "server/campaign/store.h"

#include <gmock/gmock.h>

#include "tests/server/campaign/campaign_fixture.h"

namespace stagger::server::campaign {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class StoreTest : public CampaignFixture {
 protected:
  static Record record(std::uint64_t number, double error = 0.1) {
    Record made;
    made.number = number;
    made.id = "id" + std::to_string(number);
    made.seed = (std::uint64_t{1} << 53U) - number;
    made.repeat = 3;
    made.values = R"({"push.direction_deg":15})";
    made.push = {6.0, 120.0, 0.2, 0.06};
    made.ceiling_dv = 0.7;
    made.result.outcome = sim::TrialOutcome::fell;
    made.result.reason = "fell, \"as they do\"";
    made.result.fall_time_s = 1.0 / 3.0;
    made.result.worst_dcm_error_m = error;
    made.result.ticks = 1234;
    made.result.state_hash = ~std::uint64_t{0} - number;
    made.repeated = true;
    return made;
  }
  static std::vector<std::uint64_t> numbers(const Store& store) {
    std::vector<std::uint64_t> all;
    store.for_each([&](const Record& r) { all.push_back(r.number); });
    return all;
  }
};

TEST_F(StoreTest, GivesBackToTheBitWhatWasPut) {
  Store store = store_of("a");
  EXPECT_TRUE(store.put(record(7)));
  const auto found = store.find(7);
  ASSERT_TRUE(found);
  EXPECT_EQ(hash_of(*found), hash_of(record(7)));
  EXPECT_EQ(found->push.fr, 0.06);
  EXPECT_EQ(found->ceiling_dv, 0.7);
  EXPECT_EQ(found->repeated, true);
  EXPECT_FALSE(found->passed);
  EXPECT_FALSE(found->result.steps_to_recover);
  EXPECT_FALSE(store.find(8));
  EXPECT_EQ(store.verdict(7), Verdict::fail);
  EXPECT_EQ(store.verdict(8), std::nullopt);
}

TEST_F(StoreTest, TakesNoTrialTwice) {
  Store store = store_of("a");
  EXPECT_TRUE(store.put(record(7, 0.1)));
  EXPECT_FALSE(store.put(record(7, 0.2)));
  EXPECT_EQ(store.find(7)->result.worst_dcm_error_m, 0.1);
  EXPECT_EQ(store.count(), 1U);
  EXPECT_EQ(store.counts().fell, 1U);
}

TEST_F(StoreTest, IsThereAgainWhenItIsOpenedAnew) {
  {
    Store store = store_of("a", "the text");
    for (const std::uint64_t number : {9, 2, 5}) store.put(record(number));
  }
  const Store store(folder / "a", Store::Access::read);
  EXPECT_EQ(store.specification(), "the text");
  EXPECT_EQ(store.version(), STAGGER_VERSION);
  EXPECT_THAT(numbers(store), ElementsAre(2, 5, 9));
  EXPECT_EQ(store.counts().trials, 3U);
  EXPECT_EQ(store.counts().twice, 3U);
}

TEST_F(StoreTest, IsReadPageByPage) {
  Store store = store_of("a");
  for (std::uint64_t number = 0; number < 1500; ++number) store.put(record(number * 3));
  const auto all = numbers(store);
  ASSERT_EQ(all.size(), 1500U);
  EXPECT_EQ(all.back(), 1499U * 3U);
}

TEST_F(StoreTest, AnotherConnectionReadsWhileItIsWritten) {
  Store writer = store_of("a");
  const Store reader(folder / "a", Store::Access::read);
  writer.put(record(1));
  EXPECT_EQ(reader.verdict(1), Verdict::fail);
}

TEST_F(StoreTest, ASnapshotStaysAsItWasOpened) {
  Store writer = store_of("a");
  writer.put(record(1));
  const Store snapshot(folder / "a", Store::Access::snapshot);
  EXPECT_TRUE(writer.put(record(2)));
  EXPECT_THAT(numbers(snapshot), ElementsAre(1));
  EXPECT_FALSE(snapshot.find(2));
  EXPECT_EQ(snapshot.counts().trials, 1U);
  EXPECT_THAT(numbers(writer), ElementsAre(1, 2));
}

TEST_F(StoreTest, HashDoesNotDependOnTheOrder) {
  Store a = store_of("a");
  Store b = store_of("b");
  for (const std::uint64_t number : {1, 2, 3}) a.put(record(number));
  for (const std::uint64_t number : {3, 1, 2}) b.put(record(number));
  EXPECT_EQ(results_hash(a), results_hash(b));
  Store c = store_of("c");
  for (const std::uint64_t number : {1, 2}) c.put(record(number));
  c.put(record(3, 0.1000000001));
  EXPECT_NE(results_hash(a), results_hash(c));
}

TEST_F(StoreTest, MergesShardsWithoutCountingTwice) {
  Store::create(folder / "b", "{}", Store::Journal::rollback);
  Store a = store_of("a");
  {
    Store b(folder / "b", Store::Access::write);
    for (const std::uint64_t number : {1, 2, 3}) a.put(record(number));
    for (const std::uint64_t number : {3, 4}) b.put(record(number));
  }
  const Store shard(folder / "b", Store::Access::read);
  a.merge(shard);
  a.merge(shard);
  EXPECT_THAT(numbers(a), ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(a.counts().trials, 4U);
}

TEST_F(StoreTest, MergesNothingThatContradicts) {
  Store a = store_of("a");
  a.put(record(3));
  Store b = store_of("b");
  b.put(record(1));
  b.put(record(3, 0.2));
  try {
    a.merge(b);
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("trial 3 has another result"));
  }
  EXPECT_THAT(numbers(a), ElementsAre(3));
  EXPECT_EQ(a.counts().trials, 1U);
  EXPECT_THROW(a.merge(store_of("c", "another")), std::runtime_error);
}

TEST_F(StoreTest, RefusesWhatIsNone) {
  EXPECT_THROW(Store(folder / "none", Store::Access::read), SqliteError);
  EXPECT_THROW(Store("README.md", Store::Access::read), SqliteError);
  store_of("a");
  EXPECT_THROW(Store::create(folder / "a", "{}"), SqliteError);
}

}  // namespace
}  // namespace stagger::server::campaign
