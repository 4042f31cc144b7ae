#include "sim/plant/terrain.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace stagger::sim {
namespace {

constexpr double degree = M_PI / 180.0;

TerrainParameters slope(double angle_deg, double uphill_deg) {
  TerrainParameters parameters;
  parameters.kind = TerrainKind::slope;
  parameters.slope_angle = angle_deg * degree;
  parameters.uphill_angle = uphill_deg * degree;
  return parameters;
}

TerrainParameters uneven(double height) {
  TerrainParameters parameters;
  parameters.kind = TerrainKind::uneven;
  parameters.unevenness = height;
  return parameters;
}

std::string complaint(const TerrainParameters& parameters) {
  try {
    validate(parameters);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(TerrainTest, ASlopeRisesInItsDirection) {
  const Terrain forward(slope(5.0, 0.0));
  EXPECT_NEAR(forward.height({2.0, 7.0}), 2.0 * std::tan(5.0 * degree), 1e-12);
  EXPECT_NEAR(forward.height({-2.0, 0.0}), -2.0 * std::tan(5.0 * degree), 1e-12);
  const Terrain left(slope(8.0, 90.0));
  EXPECT_NEAR(left.height({5.0, 1.0}), std::tan(8.0 * degree), 1e-12);
  EXPECT_NEAR(std::acos(left.normal().z()), 8.0 * degree, 1e-9);
  EXPECT_LT(left.normal().y(), 0.0);
  EXPECT_EQ(Terrain({}).normal(), Vec3::UnitZ());
  EXPECT_EQ(Terrain({}).height({3.0, 4.0}), 0.0);
}

TEST(TerrainTest, TilesLieBetweenZeroAndTheirGreatestHeight) {
  const Terrain terrain(uneven(0.02));
  double sum = 0.0;
  double most = 0.0;
  constexpr int side = 40;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const double height = terrain.tile_height(i - 100, j + 7);
      EXPECT_GE(height, 0.0);
      EXPECT_LE(height, 0.02);
      sum += height;
      most = std::max(most, height);
    }
  }
  EXPECT_NEAR(sum / (side * side), 0.01, 0.0005);  // three standard deviations
  EXPECT_GT(most, 0.0199);
}

TEST(TerrainTest, TilesDependOnSeedAndPlaceAlone) {
  const Terrain terrain(uneven(0.03), 4);
  const double first = terrain.tile_height(12, -3);
  terrain.tile_height(-1000, 1000);
  EXPECT_EQ(terrain.tile_height(12, -3), first);
  EXPECT_EQ(Terrain(uneven(0.03), 4).tile_height(12, -3), first);
  EXPECT_NE(Terrain(uneven(0.03), 5).tile_height(12, -3), first);
  EXPECT_NE(terrain.tile_height(-3, 12), first);
  EXPECT_EQ(terrain.height({6.24, -1.26}), first);
  EXPECT_NE(terrain.height({6.26, -1.26}), first);
}

TEST(TerrainTest, TheStartOfUnevenGroundIsLevel) {
  const Terrain terrain(uneven(0.03));
  for (const Vec2& place : {Vec2(0.24, 0.24), Vec2(-0.24, 0.24), Vec2(0.0, -0.24)}) {
    EXPECT_EQ(terrain.height(place), 0.0);
  }
  EXPECT_GT(terrain.height({0.26, 0.0}), 0.0);
}

TEST(TerrainTest, TheLastPatchThatCoversAPlaceCounts) {
  TerrainParameters parameters;
  parameters.friction = 0.7;
  parameters.patches = {{Vec2(1.0, -1.0), Vec2(3.0, 1.0), 0.3},
                        {Vec2(2.0, -1.0), Vec2(3.0, 1.0), 0.5}};
  const Terrain terrain(parameters);
  EXPECT_EQ(terrain.friction({0.9, 0.0}, 0.0), 0.7);
  EXPECT_EQ(terrain.friction({1.5, 0.9}, 0.0), 0.3);
  EXPECT_EQ(terrain.friction({1.5, 1.1}, 0.0), 0.7);
  EXPECT_EQ(terrain.friction({2.5, 0.0}, 0.0), 0.5);
}

TEST(TerrainTest, APlatformGathersItsSpeedAndThenKeepsIt) {
  TerrainParameters parameters;
  parameters.kind = TerrainKind::platform;
  parameters.platform_velocity = {0.3, -0.1};
  parameters.patches = {{Vec2(0.0, 0.0), Vec2(0.1, 0.1), 0.2}};
  const Terrain terrain(parameters);
  const auto speed = [&terrain](double time) {
    return (terrain.platform_position(time + 1e-6) - terrain.platform_position(time)).norm() / 1e-6;
  };
  EXPECT_EQ(terrain.platform_position(0.0), Vec2::Zero());
  EXPECT_NEAR(speed(0.0), 0.0, 1e-6);
  EXPECT_NEAR(speed(0.5), 0.5 * std::hypot(0.3, 0.1), 1e-5);
  EXPECT_NEAR(speed(1.0), std::hypot(0.3, 0.1), 1e-6);
  EXPECT_NEAR((terrain.platform_position(10.5) - Vec2(3.0, -1.0)).norm(), 0.0, 1e-9);
  EXPECT_EQ(terrain.friction({3.05, -0.95}, 10.5), 0.2);  // the patch has come along
  EXPECT_EQ(terrain.friction({0.05, 0.05}, 10.5), 0.8);
}

TEST(TerrainTest, AShoveGoesFromRestToRest) {
  TerrainParameters parameters;
  parameters.kind = TerrainKind::platform;
  parameters.shoves = {{2.0, 0.4, Vec2(0.1, 0.0)}, {5.0, 0.2, Vec2(0.0, -0.05)}};
  const Terrain terrain(parameters);
  const auto x = [&terrain](double time) { return terrain.platform_position(time).x(); };
  EXPECT_EQ(x(1.99), 0.0);
  EXPECT_NEAR(x(2.2), 0.05, 1e-12);
  EXPECT_NEAR(x(2.4), 0.1, 1e-12);
  EXPECT_NEAR((x(2.0 + 1e-4) - x(2.0)) / 1e-4, 0.0, 1e-4);
  // Greatest at a quarter of the time: 2 pi distance / duration^2.
  const double h = 1e-4;
  const double acceleration = (x(2.1 + h) - 2.0 * x(2.1) + x(2.1 - h)) / (h * h);
  EXPECT_NEAR(acceleration, 2.0 * M_PI * 0.1 / 0.16, 1e-3);
  EXPECT_NEAR((terrain.platform_position(9.0) - Vec2(0.1, -0.05)).norm(), 0.0, 1e-12);
}

TEST(TerrainTest, WhatIsOutOfRangeIsNamed) {
  EXPECT_EQ(complaint({}), "");
  EXPECT_EQ(complaint(slope(8.0, -360.0)), "");
  const auto with = [](const std::function<void(TerrainParameters&)>& change) {
    TerrainParameters parameters;
    change(parameters);
    return complaint(parameters);
  };
  using ::testing::StartsWith;
  EXPECT_EQ(with([](auto& t) { t.friction = 0.9; }), "friction is 0.9; allowed: 0.1 to 0.8");
  EXPECT_THAT(with([](auto& t) { t.friction = std::nan(""); }), StartsWith("friction is nan"));
  EXPECT_THAT(with([](auto& t) { t.slope_angle = 0.2; }), StartsWith("slope_angle is 0.2;"));
  EXPECT_EQ(with([](auto& t) { t.unevenness = -0.01; }),
            "unevenness is -0.01; allowed: 0 to 0.03 m");
  EXPECT_EQ(with([](auto& t) {
              t.platform_velocity = {0.4, 0.4};
            }),
            "the platform's speed is 0.565685; allowed: 0 to 0.5 m/s");
  EXPECT_EQ(with([](auto& t) {
              t.patches = {{Vec2(1.0, 0.0), Vec2(0.5, 1.0), 0.5}};
            }),
            "a patch's corner across is 0.5; allowed: 1 to 1000 m");
  EXPECT_EQ(with([](auto& t) { t.patches.resize(65); }),
            "the number of patches is 65; allowed: 0 to 64");
  EXPECT_THAT(with([](auto& t) {
                t.shoves = {{1.0, 0.01, Vec2(0.1, 0.0)}};
              }),
              StartsWith("a shove's duration_s is 0.01;"));
}

}  // namespace
}  // namespace stagger::sim
