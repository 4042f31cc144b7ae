#include "server/report/paper_report.h"

#include <gmock/gmock.h>

#include <set>

#include "server/report/paper_table.h"
#include "tests/server/paper_results.h"
#include "tests/server/text_count.h"

namespace stagger::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(PaperReport, HasAPictureForEachOfThePapersFigures) {
  const std::string html = paper_report(small_results(), "stagger <paper>");
  for (const char* id :
       {"plan-footprints", "plan-swings", "plan-references-x", "plan-references-y",
        "lqg-trajectory-x", "lqg-zmp-x", "lqg-trajectory-y", "lqg-zmp-y", "scenario1-ankle",
        "scenario1-noise", "scenario1-hip-2", "scenario1-recovered", "scenario1-lost",
        "scenario2-limits", "scenario2-directions-1", "pushes-8", "fit-pushes-8"}) {
    EXPECT_EQ(
        count(html, "<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"" + std::string(id) + "\""), 1U)
        << id;
  }
  EXPECT_EQ(count(html, "<section"), 5U);
  EXPECT_EQ(count(html, "<section"), count(html, "</section>"));
  EXPECT_EQ(count(html, "<svg"), count(html, "</svg>"));
  EXPECT_THAT(html, HasSubstr("stagger &lt;paper&gt;"));
}

TEST(PaperReport, IdsAreUnique) {
  const std::string html = paper_report(small_results(), "");
  std::set<std::string> ids;
  for (std::size_t at = html.find(" id=\""); at != std::string::npos;
       at = html.find(" id=\"", at + 1)) {
    const std::string id = html.substr(at + 5, html.find('"', at + 5) - at - 5);
    EXPECT_TRUE(ids.insert(id).second) << id;
  }
  EXPECT_GT(ids.size(), 60U);
}

TEST(PaperReport, ShowsOnlyWhatRan) {
  sim::PaperResults results;
  results.plan = sim::run_plan();
  const std::string html = paper_report(results, "");
  EXPECT_EQ(count(html, "<section"), 1U);
  EXPECT_THAT(html, Not(HasSubstr("Scenario")));
}

TEST(PaperTable, ColumnsAreAligned) {
  const std::string text = to_columns(paper_table(small_results()));
  EXPECT_THAT(text, HasSubstr("411\u2013412"));
  EXPECT_THAT(text, HasSubstr("530\u2013532"));
  EXPECT_THAT(text, HasSubstr("75.0 %\n"));
  EXPECT_THAT(text, Not(HasSubstr(" \n")));
}

TEST(PaperTable, LeastShareIsTheWorstTiming) {
  const auto results = small_results();
  EXPECT_DOUBLE_EQ(
      least_share(results.robustness[1], results.robustness[0], &sim::StrategyForces::location),
      0.5);
  EXPECT_DOUBLE_EQ(
      least_share(results.robustness[1], results.robustness[0], &sim::StrategyForces::time), 1.0);
}

TEST(PaperTable, WordsForDirectionsAndErrors) {
  constexpr double pi = 3.14159265358979323846;
  EXPECT_EQ(direction_text(0.0), "forward");
  EXPECT_EQ(direction_text(2.0 * pi), "forward");
  EXPECT_EQ(direction_text(-pi), "backward");
  EXPECT_EQ(direction_text(0.25 * pi), "45° to the left");
  EXPECT_EQ(direction_text(1.5 * pi), "90° to the right");
  EXPECT_EQ(error_text({}), "no error");
  EXPECT_EQ(error_text({.mass = 0.9, .com_height = 1.1, .delay = 0.02}),
            "mass \u221210 %, CoM height +10 %, delay 20 ms");
}

}  // namespace
}  // namespace stagger::server
