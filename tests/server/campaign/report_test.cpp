#include <gmock/gmock.h>

#include <cmath>

#include "server/report/campaign_polar.h"
#include "server/report/campaign_report.h"
#include "server/report/campaign_survival.h"
#include "tests/server/campaign/campaign_fixture.h"
#include "tests/server/text_count.h"

namespace stagger::server::campaign {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ReportTest : public CampaignFixture {
 protected:
  void run(const nlohmann::json& spec, double limit) {
    plan = plan_of(spec);
    Store::create(folder / "store", spec.dump());
    store.emplace(folder / "store", Store::Access::write);
    run_campaign(*plan, *store, options_of(limit));
  }
  std::string report(const std::string& name = "folder") {
    return campaign_report(*plan, *store, summarize(*plan, *store), name);
  }
  std::unique_ptr<Plan> plan;
  std::optional<Store> store;
};

TEST_F(ReportTest, EveryFailedTrialHasItsCommandAndIsLinkedTo) {
  run(grid(), 5.0);  // of 12 trials the 4 of 6 N s fall
  const std::string html = report("my campaign");
  EXPECT_EQ(count(html, "<tr id=\"trial-"), 4U);
  EXPECT_THAT(html, HasSubstr("stagger campaign trial &#39;my campaign&#39; 4 | stagger trial -"));
  EXPECT_THAT(html, HasSubstr("<a href=\"#trial-4\">"));
  EXPECT_THAT(html, HasSubstr("id=\"trial-4\""));
}

TEST_F(ReportTest, NeedsNothingFromElsewhereAndEscapesAllText) {
  auto spec = grid();
  spec["thresholds"] = {"falls < 100"};
  spec["base"]["push"]["link"] = "<script>alert(1)</script>";
  run(spec, 5.0);
  const std::string html = report("<b>&");
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("<b>")));
  EXPECT_THAT(html, HasSubstr("falls &lt; 100"));
  for (const char* outside : {"src=", "@import", "url(", "href=\"http", "<link"}) {
    EXPECT_THAT(html, Not(HasSubstr(outside))) << outside;
  }
}

TEST_F(ReportTest, IsTheSameForTheSameResults) {
  run(grid(), 5.0);
  EXPECT_EQ(report(), report());
  EXPECT_THAT(report(), HasSubstr("stagger " STAGGER_VERSION ", campaign seed 5"));
}

TEST_F(ReportTest, SurvivalCountsByFieldWithFirstFailure) {
  run(grid(), 5.0);
  const auto fields = varied_fields(*plan);
  ASSERT_EQ(fields.size(), 2U);
  EXPECT_EQ(fields[0].path, "push.direction_deg");
  EXPECT_EQ(fields[1].labels, (std::vector<std::string>{"2", "4", "6"}));
  const SurvivalMap map = survival_map(*plan, *store, fields[0], fields[1]);
  ASSERT_EQ(map.panels.size(), 1U);
  const Survival& harmless = map.at(map.panels[0], 1, 0);
  EXPECT_EQ(harmless.passed, 2U);
  const Survival& hard = map.at(map.panels[0], 1, 2);
  EXPECT_EQ(hard.passed, 0U);
  EXPECT_EQ(hard.failed, 2U);
  EXPECT_EQ(store->find(hard.first_failed)->values,
            R"({"push.direction_deg":90,"push.impulse_ns":6.0})");
  EXPECT_NEAR(hard.share()->high, 0.6576, 1e-4);
}

TEST_F(ReportTest, PanelsAreWhatVariesBeside) {
  auto spec = grid();
  spec["factors"]["strategies"] = {{"ankle"}, {"ankle", "hip"}};
  run(spec, 5.0);
  const auto fields = varied_fields(*plan);
  const SurvivalMap map = survival_map(*plan, *store, fields[0], fields[1]);
  ASSERT_EQ(map.panels.size(), 2U);
  EXPECT_EQ(map.panels[1].title, "ankle + hip");
  EXPECT_THAT(report(), HasSubstr("figure-ablation"));
}

TEST_F(ReportTest, LimitsOfABisectionAreInFr) {
  run(bisection(1.0), 9.5);
  const auto panels = polar_panels(*plan, limits_of(*plan, *store));
  ASSERT_EQ(panels.size(), 1U);
  ASSERT_EQ(panels[0].series.size(), 1U);
  ASSERT_EQ(panels[0].series[0].limits.size(), 2U);
  const PolarLimit& limit = panels[0].series[0].limits[1];
  EXPECT_EQ(limit.direction_deg, 90.0);
  // 9 N s on 30 kg whose CoM is 1 m high.
  EXPECT_NEAR(*limit.pass, 9.0 / 30.0 / std::sqrt(9.81), 1e-3);
  EXPECT_GT(*limit.fail, *limit.pass);
  EXPECT_TRUE(limit.monotone);
  EXPECT_THAT(report(), HasSubstr("figure-limits"));
  EXPECT_THAT(report(), HasSubstr("IHMC Atlas"));
}

TEST_F(ReportTest, TheMapsLegendHasTheIntervalOfEachTally) {
  run(grid(), 5.0);
  const std::string html = report();
  EXPECT_EQ(count(html, ">2 of 2 (34–100 %)<"), 1U);
  EXPECT_EQ(count(html, ">0 of 2 (0–66 %)<"), 1U);
}

TEST_F(ReportTest, FiguresAreFilesWithTheirConditions) {
  run(bisection(1.0), 9.5);
  const auto files = campaign_figures(*plan, *store, summarize(*plan, *store));
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].name, "limits.svg");
  EXPECT_EQ(files[1].name, "survival.svg");
  for (const FigureFile& file : files) {
    EXPECT_THAT(file.svg, HasSubstr("stagger " STAGGER_VERSION ", campaign seed 5"));
    EXPECT_THAT(file.svg, Not(HasSubstr("var(")));
    EXPECT_THAT(file.svg, Not(HasSubstr("<a ")));
    EXPECT_EQ(count(file.svg, "<svg"), count(file.svg, "</svg>"));
  }
}

TEST_F(ReportTest, ACeilingOutsideOfThePictureIsANumber) {
  run(bisection(1.0), 9.5);
  auto panels = polar_panels(*plan, limits_of(*plan, *store));
  auto& limits = panels.at(0).series.at(0).limits;
  limits.at(0).ceiling = 1.25;
  limits.at(1).ceiling = 0.2;
  const std::string picture = to_svg(polar_plot(panels[0], 0.5, 386.0, "polar"));
  EXPECT_THAT(picture, HasSubstr(">ceiling 1.25<"));
  EXPECT_THAT(picture, Not(HasSubstr("ceiling 0.20")));
}

TEST_F(ReportTest, SaysWhatIsMissing) {
  run(grid(), 100.0);
  EXPECT_THAT(report(), HasSubstr("None: all trials passed."));
  const auto other = plan_of(grid());
  const Store empty = store_of("empty", grid().dump());
  const std::string html = campaign_report(*other, empty, summarize(*other, empty), "folder");
  EXPECT_THAT(html, HasSubstr("This campaign is not complete"));
}

}  // namespace
}  // namespace stagger::server::campaign
