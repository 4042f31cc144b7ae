#include "server/json/limits_json.h"

#include <gmock/gmock.h>

#include "server/cli/progress_line.h"
#include "server/report/limits_table.h"

namespace stagger::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class LimitsJson : public ::testing::Test {
 protected:
  LimitsJson() {
    spec.trial.robot = "kasaei";
    spec.trial.walk.vx = 0.2;
    spec.trial.observe_s = 6.0;
    spec.cells = {{0.0, 0.35, 0.01}, {90.0, 0.35, 0.01}, {0.0, {}, 0.01}};
    spec.rungs = {0.1, 0.2, 0.3};
    spec.seeds = {4, 5};
    sim::PushSpec push;
    push.link = "torso";
    spec.trial.push = push;
    for (const sim::LimitCell& cell : spec.cells) {
      sim::Limit limit;
      limit.cell = cell;
      limits.push_back(limit);
    }
    limits[0].pass_dv = 0.2;
    limits[0].fail_dv = 0.3;
    limits[0].fail_seed = 5;
    limits[0].fail_reason = "fell: it did";
    limits[0].ceiling_dv = 0.4;
    limits[0].seeds_alike = false;
    limits[1].fail_dv = 0.1;
    limits[1].ceiling_dv = 0.5;
    limits[2].pass_dv = 0.3;
  }
  std::shared_ptr<const sim::Robot> robot = sim::load_robot("robots/kasaei");
  sim::LimitsSpec spec;
  std::vector<sim::Limit> limits;
};

TEST_F(LimitsJson, TellsEveryLimitInEveryUnit) {
  const Json results = limits_json(spec, limits, *robot)["results"];
  ASSERT_EQ(results.size(), 3U);
  const Json& first = results[0];
  EXPECT_EQ(first["direction_deg"], 0.0);
  EXPECT_EQ(first["phase"], 0.35);
  EXPECT_EQ(first["duration_s"], 0.01);
  EXPECT_EQ(first["seeds"], 2);
  EXPECT_EQ(first["seeds_alike"], false);
  EXPECT_EQ(first["pass_dv"], 0.2);
  EXPECT_EQ(first["fail_dv"], 0.3);
  EXPECT_EQ(first["fail_seed"], 5);
  EXPECT_NEAR(first["pass_ns"].get<double>(), 0.2 * 30.0, 1e-9);
  EXPECT_NEAR(first["fr"].get<double>(), 0.2 / std::sqrt(9.81), 1e-9);
  EXPECT_NEAR(first["ceiling_percent"].get<double>(), 50.0, 1e-9);
}

TEST_F(LimitsJson, WhatIsNotKnownIsNull) {
  const Json results = limits_json(spec, limits, *robot)["results"];
  for (const char* field : {"pass_dv", "pass_ns", "fr", "ceiling_percent"}) {
    EXPECT_TRUE(results[1][field].is_null()) << field;
  }
  EXPECT_EQ(results[1]["fail_dv"], 0.1);
  EXPECT_EQ(results[2]["phase"], "standing");
  for (const char* field : {"fail_dv", "fail_seed", "ceiling_dv", "ceiling_percent"}) {
    EXPECT_TRUE(results[2][field].is_null()) << field;
  }
}

TEST_F(LimitsJson, ConditionsAreThoseOfTheTrialsAndMore) {
  const Json conditions = limits_json(spec, limits, *robot)["conditions"];
  EXPECT_EQ(conditions["robot"], "kasaei");
  EXPECT_EQ(conditions["plant"], "bullet");
  EXPECT_EQ(conditions["walk"]["vx"], 0.2);
  EXPECT_EQ(conditions["strategies"], Json({"ankle", "hip", "step", "time"}));
  EXPECT_EQ(conditions["observe_s"], 6.0);
  EXPECT_EQ(conditions["push"], Json({{"link", "torso"}, {"profile", "rectangular"}}));
  EXPECT_EQ(conditions["leg"], "left");
  EXPECT_EQ(conditions["ladder"], Json({0.1, 0.2, 0.3}));
  EXPECT_EQ(conditions["seeds"], Json({4, 5}));
  EXPECT_NEAR(conditions["mass_kg"].get<double>(), 30.0, 1e-9);
  EXPECT_EQ(conditions["com_height_m"], 1.0);
  EXPECT_EQ(conditions["criteria"]["recover_within_s"], 4.0);
  EXPECT_EQ(conditions["version"], STAGGER_VERSION);
  // These differ from trial to trial.
  EXPECT_FALSE(conditions.contains("seed"));
  EXPECT_FALSE(conditions.contains("stand"));
}

TEST_F(LimitsJson, AsATable) {
  const std::string text = limits_columns(spec, limits, *robot);
  EXPECT_THAT(text, HasSubstr("fell: it did"));
  EXPECT_THAT(text, HasSubstr("standing"));
  EXPECT_THAT(text, Not(HasSubstr(" \n")));
}

TEST_F(LimitsJson, AsAPage) {
  const std::string page = limits_markdown(spec, limits, *robot, "stagger limits", "2030-01-02");
  EXPECT_THAT(page, HasSubstr("2030-01-02"));
  EXPECT_THAT(page, HasSubstr(STAGGER_VERSION));
  EXPECT_THAT(page, HasSubstr("| direction | 0.35 | standing |\n"));
  EXPECT_THAT(page, HasSubstr("| 0° | 0.2 (50 %) | >= 0.3 |\n"));
  EXPECT_THAT(page, HasSubstr("| 90° | < 0.1 |"));
}

TEST(ProgressText, TellsWhatIsLeftAtMost) {
  const std::string text = progress_text({0.35, 12, 50, 150}, 40.0);
  EXPECT_THAT(text, HasSubstr("[#####...............]"));
  EXPECT_THAT(text, HasSubstr("0.35 m/s, 12 pushes"));
  EXPECT_THAT(text, HasSubstr("at most 2:00 left"));
}

}  // namespace
}  // namespace stagger::server
