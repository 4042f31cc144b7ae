#include "server/report/figure.h"

#include <gmock/gmock.h>

#include "tests/server/text_count.h"

namespace stagger::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Figure three_plots() {
  Figure figure{"figure-three", "Caption", 2, {}, true};
  for (const char* id : {"a", "b", "c"}) {
    Plot plot;
    plot.id = id;
    plot.width = 300.0;
    plot.height = 200.0;
    plot.layers = {LineLayer{"measured", {}, {{0.0, 0.0}, {1.0, 2.0}}}};
    figure.plots.push_back(plot);
  }
  return figure;
}

TEST(Figure, PlotsShareOneLegend) {
  const Figure figure = three_plots();
  EXPECT_EQ(count(legend_of(figure), ">measured<"), 1U);
  for (const std::string& picture : pictures_of(figure)) {
    EXPECT_THAT(picture, Not(HasSubstr(">measured<")));
  }
  Figure apart = three_plots();
  apart.one_legend = false;
  EXPECT_EQ(legend_of(apart), "");
  EXPECT_THAT(pictures_of(apart).front(), HasSubstr(">measured<"));
}

TEST(Figure, AFileSetsThePlotsInRows) {
  const std::string file = figure_file(three_plots(), "note");
  EXPECT_THAT(file, HasSubstr("viewBox=\"0 0 652 "));  // two plots, the gap and both margins
  EXPECT_EQ(count(file, "translate(12 "), 3U);         // legend and the first of either row
  EXPECT_EQ(count(file, "translate(340 "), 1U);
  EXPECT_EQ(count(file, ">measured<"), 1U);
  EXPECT_EQ(count(file, "<style>"), 1U);
}

TEST(Figure, AFilesNoteIsBrokenIntoLinesAndEscaped) {
  std::string note;
  for (int i = 0; i < 60; ++i) note += "word & ";
  const std::string file = figure_file(three_plots(), note);
  EXPECT_GT(count(file, "class=\"foot\""), 2U);
  EXPECT_THAT(file, Not(HasSubstr("word & ")));
}

}  // namespace
}  // namespace stagger::server
