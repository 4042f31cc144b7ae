#include "engine/ground_slope.h"

#include <gtest/gtest.h>

namespace stagger::engine {
namespace {

/// Footholds of a walk along x, 0.15 m a step, feet 0.2 m apart, on a ground.
template <typename Height>
GroundSlope walked(int steps, Height height) {
  GroundSlope slope;
  Vec3 from(0.0, 0.1, height(0.0, 0.1));
  for (int i = 1; i <= steps; ++i) {
    const double x = 0.15 * i;
    const double y = i % 2 == 0 ? 0.1 : -0.1;
    const Vec3 to(x, y, height(x, y));
    slope.learn(from, to);
    from = to;
  }
  return slope;
}

TEST(GroundSlopeTest, LearnsAPlane) {
  const auto plane = [](double x, double y) { return 0.09 * x - 0.05 * y; };
  // To within what the tolerance leaves open.
  const GroundSlope slope = walked(40, plane);
  EXPECT_NEAR(slope.rise({0.15, 0.2}), plane(0.15, 0.2), GroundSlope::tolerance);
  EXPECT_NEAR(slope.rise({0.15, -0.2}), plane(0.15, -0.2), GroundSlope::tolerance);
  EXPECT_LT((walked(6, plane).gradient() - Vec2(0.09, -0.05)).norm(), 0.05);
}

TEST(GroundSlopeTest, LevelGroundLeavesItExactlyLevel) {
  const auto level = [](double x, double) { return x > 1.0 ? 0.3 : 0.3019; };
  EXPECT_EQ(walked(10, level).gradient(), Vec2::Zero());
}

TEST(GroundSlopeTest, OneTileMovesItLittle) {
  const auto tile = [](double x, double) { return x > 1.4 && x < 1.6 ? 0.02 : 0.0; };
  EXPECT_LT(std::abs(walked(10, tile).rise({0.15, 0.2})), 0.007);
  EXPECT_LT(std::abs(walked(30, tile).rise({0.15, 0.2})), 0.003);
}

TEST(GroundSlopeTest, NothingIsSteeperThanItsLimit) {
  const auto wall = [](double x, double) { return x; };
  EXPECT_NEAR(walked(40, wall).gradient().norm(), GroundSlope::most, 1e-12);
}

TEST(GroundSlopeTest, TwoFootholdsAtOnePlaceDoNoHarm) {
  GroundSlope slope;
  slope.learn({0.0, 0.0, 0.0}, {0.0, 0.0, 0.01});
  EXPECT_EQ(slope.gradient(), Vec2::Zero());
}

}  // namespace
}  // namespace stagger::engine
