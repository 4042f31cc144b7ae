#include "engine/sole_gap.h"

#include <gtest/gtest.h>

#include <random>

namespace stagger::engine {
namespace {

constexpr Sole sole{0.12, 0.05};

/// Distance between the outlines by brute force: the points of one from the rectangle of the other.
double sampled_gap(const Vec2& offset, double turn) {
  double least = 1e9;
  constexpr int n = 400;
  for (int i = 0; i <= n; ++i) {
    const double u = -1.0 + 2.0 * i / n;
    for (const Vec2& point :
         {Vec2(u * sole.half_length, sole.half_width), Vec2(u * sole.half_length, -sole.half_width),
          Vec2(sole.half_length, u * sole.half_width),
          Vec2(-sole.half_length, u * sole.half_width)}) {
      const Vec2 in_first = offset + rotated(point, turn);
      const double x = std::max(std::abs(in_first.x()) - sole.half_length, 0.0);
      const double y = std::max(std::abs(in_first.y()) - sole.half_width, 0.0);
      least = std::min(least, std::hypot(x, y));
    }
  }
  return least;
}

TEST(SoleGap, SideBySideAndOneBehindTheOther) {
  EXPECT_NEAR(sole_gap(sole, {0.0, 0.13}, 0.0), 0.03, 1e-12);
  EXPECT_NEAR(sole_gap(sole, {-0.3, 0.02}, 0.0), 0.06, 1e-12);
  EXPECT_NEAR(sole_gap(sole, {0.27, 0.14}, 0.0), 0.05, 1e-12);  // corner to corner: 3, 4, 5
  EXPECT_NEAR(sole_gap(sole, {0.0, 0.2}, M_PI / 2), 0.2 - 0.05 - 0.12, 1e-12);
  EXPECT_LT(sole_gap(sole, {0.1, 0.05}, 0.3), 0.0);
}

TEST(SoleGap, AgreesWithSampledOutlines) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-0.4, 0.4);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  int apart = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec2 offset(place(random), place(random));
    const double turn = angle(random);
    const double gap = sole_gap(sole, offset, turn);
    const double sampled = std::min(sampled_gap(offset, turn),  // corners of one, then of the other
                                    sampled_gap(rotated(-offset, -turn), -turn));
    EXPECT_NEAR(std::max(gap, 0.0), sampled, 1e-3) << offset.transpose() << ", " << turn;
    if (gap > 0.0) ++apart;
    for (const double clearance : {0.0, 0.02, 0.1}) {
      EXPECT_EQ(soles_clear(sole, offset, turn, clearance), gap >= clearance);
    }
  }
  EXPECT_GT(apart, 500);
  EXPECT_LT(apart, 1900);
}

}  // namespace
}  // namespace stagger::engine
