#include "server/json/paper_json.h"

#include <gmock/gmock.h>

#include "tests/server/paper_results.h"

namespace stagger::server {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> names;
  for (const auto& item : json.items()) names.push_back(item.key());
  return names;
}

TEST(PaperJson, HasAKeyForEachSectionThatRan) {
  EXPECT_THAT(keys(paper_json({})), ElementsAre("version"));
  EXPECT_THAT(keys(paper_json(small_results())),
              ElementsAre("plan", "lqg", "scenario1", "scenario2", "robustness", "version"));
}

TEST(PaperJson, ScenarioOne) {
  const Json json = paper_json(small_results())["scenario1"];
  EXPECT_EQ(json["simulations"], 3);
  EXPECT_EQ(json["published"]["simulations"], 441);
  EXPECT_EQ(json["ankle"]["recovered"], 1);
  EXPECT_EQ(json["ankle"]["bound"], 2);
  EXPECT_EQ(json["ankle_noise"]["seeds"], 3);
  EXPECT_EQ(json["hip"][1]["torque_nm"], 40.0);
  for (const char* key : {"inertia", "angle_rad", "recovered", "bound", "beyond"}) {
    EXPECT_TRUE(json["hip"][1].contains(key)) << key;
  }
}

TEST(PaperJson, ScenarioTwo) {
  const Json json = paper_json(small_results())["scenario2"];
  const Json& entry = json["stagger"][0];
  EXPECT_EQ(entry["t_left"], 0.6);
  EXPECT_EQ(entry["direction_deg"], 0.0);
  EXPECT_EQ(entry["location_n"], 2100.0);
  EXPECT_EQ(entry["ceiling"]["time_n"], 4000.0);
  EXPECT_EQ(entry["percent"]["location"], 75.0);
  EXPECT_EQ(entry["gain_percent"]["total"], 400.0);
  EXPECT_EQ(entry["noise_median"]["ankle_n"], 690.0);
  EXPECT_EQ(json["directions"][0]["direction_deg"], 90.0);
  EXPECT_FALSE(json["directions"][0].contains("noise_median"));
  for (const char* key :
       {"ankle_n", "location_n", "time_n", "land_350_m", "land_400_m", "dt_412_s", "dt_460_s"}) {
    EXPECT_EQ(json["paper_fit"][key], json["published"][key]) << key;
  }
  EXPECT_EQ(json["paper_fit"]["worst_deviation_percent"], 0.0);
  EXPECT_EQ(json["pushes"]["paper_fit"].size(), 8U);
  EXPECT_EQ(json["pushes"]["stagger"][1]["published"]["land_m"], 0.71);
  EXPECT_TRUE(json["pushes"]["stagger"][0]["published"]["land_m"].is_null());
}

TEST(PaperJson, NothingIsComparedWithACeilingThatIsNotThere) {
  sim::PaperResults results = small_results();
  results.stepping->limits[0].ceiling.ankle = 0.0;
  EXPECT_TRUE(paper_json(results)["scenario2"]["stagger"][0]["percent"]["ankle"].is_null());
}

}  // namespace
}  // namespace stagger::server
