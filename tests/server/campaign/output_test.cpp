#include "server/campaign/output.h"

#include <gmock/gmock.h>

#include <sstream>

#include "server/campaign/folder.h"
#include "server/campaign/summary_json.h"
#include "tests/server/campaign/campaign_fixture.h"

namespace stagger::server::campaign {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class OutputTest : public CampaignFixture {
 protected:
  OutputTest() {
    auto spec = grid();
    spec["thresholds"] = {"fall_rate == 0", "falls < 100"};
    plan = plan_of(spec);
    run_campaign(*plan, store, options_of(5.0));
  }
  template <typename... Arguments>
  static std::string written(void (*write)(std::ostream&, Arguments...), const auto&... arguments) {
    std::ostringstream out;
    write(out, arguments...);
    return out.str();
  }
  std::unique_ptr<Plan> plan;
  Store store = store_of("store");
};

TEST_F(OutputTest, CsvHasAColumnForEachFactor) {
  const std::string csv = written(write_csv, *plan, store);
  EXPECT_THAT(csv, StartsWith("number,id,seed,repeat,push.direction_deg,push.impulse_ns,outcome,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 13);
  EXPECT_THAT(csv, HasSubstr(",90,4.0,recovered,true,,4.0,80.0,"));
}

TEST_F(OutputTest, NdjsonHoldsWhatReplaysATrial) {
  std::istringstream lines(written(write_ndjson, *plan, store));
  std::string line;
  int count = 0;
  for (; std::getline(lines, line); ++count) {
    const Json trial = Json::parse(line);
    EXPECT_EQ(trial["number"], count);
    EXPECT_EQ(trial["spec"]["seed"], trial["seed"]);
    EXPECT_EQ(trial["spec"]["push"]["impulse_ns"], trial["values"]["push.impulse_ns"]);
  }
  EXPECT_EQ(count, 12);
}

TEST_F(OutputTest, LinesHoldNothingOfTheStoreBetweenTheirPages) {
  Store other = store_of("other");
  Record record = *store.find(0);
  for (record.number = 0; record.number < Store::page_size; ++record.number) other.put(record);
  const Store reader(folder / "other", Store::Access::read);
  TrialLines lines(*plan, reader, TrialLines::Format::csv);
  std::string text;
  ASSERT_TRUE(lines.next(text));

  other.put(record);
  // With a reader in a transaction the log could not be emptied.
  Database database(folder / "other", Database::Access::write);
  Statement checkpoint = database.prepare("PRAGMA wal_checkpoint(TRUNCATE)");
  ASSERT_TRUE(checkpoint.step());
  EXPECT_EQ(checkpoint.integer(0), 0) << "is busy";

  EXPECT_FALSE(lines.next(text));
  EXPECT_EQ(text, written(write_csv, *plan, other));
}

TEST_F(OutputTest, JunitTellsWhichThresholdFailed) {
  const std::string xml = written(write_junit, *plan, summarize(*plan, store));
  EXPECT_THAT(xml, HasSubstr("tests=\"5\" failures=\"1\""));
  EXPECT_THAT(xml, HasSubstr("name=\"fall_rate == 0\"><failure message=\"the value is 0.333"));
  EXPECT_THAT(xml, HasSubstr("name=\"falls &lt; 100\"/>"));
}

TEST_F(OutputTest, SummaryHasItsConditions) {
  const Json json = summary_json(*plan, store, summarize(*plan, store));
  EXPECT_EQ(json["state"], "complete");
  EXPECT_EQ(json["trials"], 12);
  EXPECT_EQ(json["fell"], 4);
  EXPECT_EQ(json["conditions"]["trial"]["plant"], "lipm");
  EXPECT_FALSE(json["conditions"]["trial"].contains("push"));
  EXPECT_EQ(json["conditions"]["base"]["push"]["duration_s"], 0.05);
  EXPECT_EQ(json["thresholds"][0]["passed"], false);
  EXPECT_EQ(json["version"], STAGGER_VERSION);
}

TEST_F(OutputTest, AFolderIsMadeOnceAndRunByOneProcess) {
  const Folder made(folder / "campaign");
  made.create("{}");
  EXPECT_TRUE(made.holds_campaign());
  EXPECT_THROW(made.create("{}"), std::runtime_error);
  const FolderLock lock(made);
  EXPECT_THROW(FolderLock again(made), std::runtime_error);
  made.write_files(*plan, store, summarize(*plan, store));
  for (const char* name : {"summary.json", "trials.csv", "trials.ndjson", "junit.xml"}) {
    EXPECT_TRUE(std::filesystem::exists(made.path() / name)) << name;
    EXPECT_FALSE(std::filesystem::exists(made.path() / (std::string(name) + ".part")));
  }
}

}  // namespace
}  // namespace stagger::server::campaign
