#include "server/report/svg.h"

#include <gmock/gmock.h>

#include <cmath>

namespace stagger::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Svg, EscapesEveryText) {
  EXPECT_EQ(escaped(R"(a<b & "c">'d')"), "a&lt;b &amp; &quot;c&quot;&gt;&#39;d&#39;");
  EXPECT_EQ(escaped("\u03c9 \x01\x1fm\u00b2"), "\u03c9 m\u00b2");
}

TEST(Svg, NoLabelBreaksThePicture) {
  const std::string evil = R"("/></svg><script>&)";
  Svg svg(evil, 100.0, 50.0, evil, evil);
  svg.text({1.0, 2.0}, evil, "tick");
  const std::string text = std::move(svg).finish();
  EXPECT_THAT(text, Not(HasSubstr("<script")));
  EXPECT_THAT(text, Not(HasSubstr("\"/></svg>&")));
  EXPECT_EQ(text.find("</svg>"), text.rfind("</svg>"));
  EXPECT_THAT(text, HasSubstr("<title id="));
  EXPECT_THAT(text, HasSubstr("<desc id="));
}

TEST(Svg, ShapesAsWritten) {
  Svg svg("p", 100.0, 50.0, "t", "d");
  const std::vector<Pixel> points{{0.0, 1.0}, {2.5, -3.04}, {4.0, 5.0}};
  svg.polyline(points, {Ink::reference, 1.5, true});
  svg.polygon(points, {Ink::limit, 0.25});
  svg.line({0.0, 0.0}, {1.0, 1.0}, {});
  const std::string text = std::move(svg).finish();
  EXPECT_THAT(text, HasSubstr("viewBox=\"0 0 100 50\""));
  EXPECT_THAT(text, HasSubstr("<path d=\"M0 1L2.5 -3L4 5\" class=\"line reference dashed\""));
  EXPECT_THAT(text,
              HasSubstr("<path d=\"M0 1L2.5 -3L4 5Z\" class=\"area limit\" fill-opacity=\"0.25\""));
  EXPECT_THAT(text, HasSubstr("<line x1=\"0\" y1=\"0\" x2=\"1\" y2=\"1\" class=\"line measured\""));
}

TEST(Svg, SimplifiedKeepsTheLineWithinTolerance) {
  std::vector<Pixel> wave;
  for (int i = 0; i <= 1000; ++i) wave.push_back({0.5 * i, 40.0 * std::sin(0.01 * i)});
  const std::vector<Pixel> less = simplified(wave, 0.1);
  EXPECT_LT(less.size(), wave.size() / 8);
  EXPECT_EQ(less.front().x, wave.front().x);
  EXPECT_EQ(less.back().x, wave.back().x);
  std::size_t k = 0;
  for (const Pixel& point : wave) {
    while (less[k + 1].x < point.x) ++k;
    const Pixel& a = less[k];
    const Pixel& b = less[k + 1];
    const double share = (point.x - a.x) / (b.x - a.x);
    EXPECT_NEAR(a.y + share * (b.y - a.y), point.y, 0.13) << point.x;
  }
}

TEST(Svg, SimplifiedKeepsCornersAndDropsWhatLiesBetween) {
  const std::vector<Pixel> step{{0, 0}, {1, 0}, {2, 0}, {2, 9}, {3, 9}, {4, 9}};
  const std::vector<Pixel> less = simplified(step, 0.1);
  ASSERT_EQ(less.size(), 4U);
  EXPECT_EQ(less[1].x, 2.0);
  EXPECT_EQ(less[2].y, 9.0);
  EXPECT_EQ(simplified(std::vector<Pixel>{{1, 1}, {1, 1}}, 0.1).size(), 2U);
  // There and back again: the far end is no point between.
  EXPECT_EQ(simplified(std::vector<Pixel>{{0, 0}, {5, 0}, {0, 0}}, 0.1).size(), 3U);
}

TEST(Svg, TextWidthCountsCharactersNotBytes) {
  EXPECT_DOUBLE_EQ(text_width("\u03c9\u03c9", 12.0), text_width("ab", 12.0));
}

}  // namespace
}  // namespace stagger::server
