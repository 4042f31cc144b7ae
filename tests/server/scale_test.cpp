#include "server/report/scale.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace stagger::server {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::Pointwise;

TEST(Scale, TicksAreMultiplesOfOneTwoOrFive) {
  const Ticks ticks = nice_ticks({0.0, 3.0}, 7);
  EXPECT_DOUBLE_EQ(ticks.step, 0.5);
  EXPECT_EQ(ticks.decimals, 1);
  EXPECT_THAT(ticks.values, Pointwise(DoubleNear(1e-12), {0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0}));
  EXPECT_DOUBLE_EQ(nice_ticks({0.0, 3509.0}, 8).step, 500.0);
  EXPECT_EQ(nice_ticks({0.0, 3509.0}, 8).decimals, 0);
  EXPECT_DOUBLE_EQ(nice_ticks({-0.012, 0.013}, 4).step, 0.01);
  EXPECT_EQ(nice_ticks({-0.012, 0.013}, 4).decimals, 2);
}

TEST(Scale, TicksLieInsideAndAreNeverTooMany) {
  for (const double low : {-7e5, -1.0, -1e-3, 0.0, 0.3, 12345.0}) {
    for (const double span : {1e-6, 0.01, 0.09999, 1.0, 2.5, 99.0, 1e7}) {
      if (span < 1e-9 * std::abs(low)) continue;  // is widened
      for (const int most : {2, 3, 5, 12}) {
        const Ticks ticks = nice_ticks({low, low + span}, most);
        EXPECT_LE(ticks.values.size(), static_cast<std::size_t>(most)) << low << ' ' << span;
        for (const double value : ticks.values) {
          EXPECT_GE(value, low - 1e-6 * ticks.step);
          EXPECT_LE(value, low + span + 1e-6 * ticks.step);
        }
        const double mantissa = ticks.step / std::pow(10.0, std::floor(std::log10(ticks.step)));
        EXPECT_TRUE(std::abs(mantissa - 1.0) < 1e-6 || std::abs(mantissa - 2.0) < 1e-6 ||
                    std::abs(mantissa - 5.0) < 1e-6 || std::abs(mantissa - 10.0) < 1e-6)
            << ticks.step;
      }
    }
  }
}

TEST(Scale, RangesThatCannotBeDrawnAreReplaced) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(usable({infinity, -infinity}).span(), 1.0);
  EXPECT_EQ(usable({std::nan(""), 1.0}).span(), 1.0);
  const Range zero = usable({0.0, 0.0});
  EXPECT_LT(zero.low, 0.0);
  EXPECT_GT(zero.high, 0.0);
  const Range point = usable({5.0, 5.0});
  EXPECT_LT(point.low, 5.0);
  EXPECT_GT(point.high, 5.0);
  EXPECT_EQ(usable({2.0, 1.0}).low, 1.0);
  EXPECT_FALSE(nice_ticks({3.0, 3.0}, 5).values.empty());
}

TEST(Scale, NiceRangeEndsAtTicks) {
  const Range range = nice_range({0.0, 3683.0}, 8);
  EXPECT_EQ(range.low, 0.0);
  EXPECT_EQ(range.high, 4000.0);
  EXPECT_EQ(nice_range({0.0, 4000.0}, 8).high, 4000.0);
}

TEST(Scale, NumbersAsText) {
  EXPECT_EQ(fixed(-0.25, 2), "\u22120.25");
  EXPECT_EQ(fixed(-0.001, 2), "0.00");
  EXPECT_EQ(fixed(1234.5, 0), "1234");
  EXPECT_EQ(fixed(std::nan(""), 1), "\u2014");
  EXPECT_EQ(significant(0.0, 2), "0");
  EXPECT_EQ(significant(0.01234, 2), "0.012");
  EXPECT_EQ(significant(5.66e-15, 2), "5.7 \u00d7 10\u207b\u00b9\u2075");
  EXPECT_EQ(coordinate(12.0), "12");
  EXPECT_EQ(coordinate(-0.04), "0");
  EXPECT_EQ(coordinate(-3.25, 2), "-3.25");
  EXPECT_EQ(coordinate(100.0, 0), "100");
}

TEST(Scale, MapsEndsToEnds) {
  const LinearScale down({-1.0, 3.0}, {200.0, 0.0});
  EXPECT_DOUBLE_EQ(down(-1.0), 200.0);
  EXPECT_DOUBLE_EQ(down(3.0), 0.0);
  EXPECT_DOUBLE_EQ(down(1.0), 100.0);
}

}  // namespace
}  // namespace stagger::server
