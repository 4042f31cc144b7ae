#include "server/report/svg_plot.h"

#include <gmock/gmock.h>

#include <limits>

#include "tests/server/text_count.h"

namespace stagger::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Plot simple() {
  Plot plot;
  plot.id = "simple";
  plot.title = "Title";
  plot.description = "Description";
  plot.x.label = "time (s)";
  plot.y.label = "x (m)";
  plot.layers = {LineLayer{"measured", {}, {{0.0, 0.0}, {1.0, 2.0}}}};
  return plot;
}

TEST(SvgPlot, HasAxesTitleAndLegend) {
  const std::string svg = to_svg(simple());
  for (const char* text : {">time (s)<", ">x (m)<", ">Title<", ">Description<", ">measured<"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
  EXPECT_EQ(svg, to_svg(simple()));
}

TEST(SvgPlot, LegendNamesEveryNameOnceAndOnlyWhenAsked) {
  Plot plot = simple();
  plot.layers.emplace_back(LineLayer{"measured", {}, {{0.0, 1.0}, {1.0, 1.0}}});
  plot.layers.emplace_back(DotLayer{"", {}, {{0.5, 0.5}}});
  EXPECT_EQ(count(to_svg(plot), ">measured<"), 1U);
  plot.legend = false;
  EXPECT_EQ(count(to_svg(plot), ">measured<"), 0U);
}

TEST(SvgPlot, GivenRangeMapsToTheFrame) {
  Plot plot = simple();
  plot.x.range = Range{0.0, 10.0};
  plot.y.range = Range{-1.0, 1.0};
  plot.x.marks = {{0.0, "left"}, {10.0, "right"}, {11.0, "beyond"}};
  const std::string svg = to_svg(plot);
  EXPECT_THAT(svg, HasSubstr(">left<"));
  EXPECT_THAT(svg, HasSubstr(">right<"));
  EXPECT_THAT(svg, Not(HasSubstr(">beyond<")));
}

TEST(SvgPlot, BadNumbersAndBadTextDoNoHarm) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  Plot plot = simple();
  plot.title = "a < b & \"c\"";
  plot.y.label = "<unit>";
  plot.layers = {LineLayer{"<&\">", {}, {{0.0, nan}, {1.0, infinity}, {2.0, 1.0}, {3.0, 1e300}}},
                 BoxLayer{"boxes", {}, {{{0.0, 0.0}, {infinity, nan}}}, true, 3.0},
                 AreaLayer{"area", {}, {{nan, nan}}}, DotLayer{"dots", {}, {}},
                 NoteLayer{{nan, 1.0}, "<note>"}};
  const std::string svg = to_svg(plot);
  EXPECT_THAT(svg, HasSubstr("&lt;&amp;&quot;&gt;"));
  EXPECT_THAT(svg, HasSubstr("&lt;note&gt;"));
  for (const char* bad : {"nan", "inf", "<note>", "<unit>", "e+"}) {
    EXPECT_THAT(svg, Not(HasSubstr(bad)));
  }
  EXPECT_EQ(count(svg, "<svg"), count(svg, "</svg>"));
}

TEST(SvgPlot, AnEmptyPlotIsAFrame) {
  Plot plot = simple();
  plot.layers.clear();
  EXPECT_THAT(to_svg(plot), HasSubstr("<rect"));
}

TEST(SvgPlot, EqualAspectMakesASquareOfASquare) {
  Plot plot = simple();
  plot.equal_aspect = true;
  plot.layers = {BoxLayer{"", {}, {{{-1.0, -1.0}, {1.0, 1.0}}}}};
  const std::string svg = to_svg(plot);
  const auto number_after = [&](const std::string& name, std::size_t from) {
    return std::stod(svg.substr(svg.find(name, from) + name.size()));
  };
  const std::size_t box = svg.find("<rect");
  EXPECT_NEAR(number_after("width=\"", box), number_after("height=\"", box), 0.2);
}

TEST(SvgPlot, RangesOverAllLayers) {
  const std::vector<Layer> layers{LineLayer{"", {}, {{0.0, 5.0}, {2.0, 6.0}}},
                                  BoxLayer{"", {}, {{{-3.0, 0.0}, {1.0, 1.0}}}},
                                  NoteLayer{{99.0, 99.0}, "note"}};
  EXPECT_EQ(x_range(layers).low, -3.0);
  EXPECT_EQ(x_range(layers).high, 2.0);
  EXPECT_EQ(y_range(layers).low, 0.0);
  EXPECT_EQ(y_range(layers).high, 6.0);
}

}  // namespace
}  // namespace stagger::server
