// Tier 3: the full body walks on ground that its engine is told nothing of.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/simulation.h"
#include "tests/sim/kasaei.h"

namespace stagger::sim {
namespace {

struct WalkedTerrain {
  std::string fall;
  Vec2 way;  ///< of the CoM
};

WalkedTerrain walk(const TerrainParameters& terrain, double seconds, std::uint64_t seed = 1,
                   const engine::WalkCommand& command = {0.3, 0.0, 0.0},
                   const std::shared_ptr<const Robot>& robot = kasaei()) {
  SimulationConfig config;
  config.robot = robot;
  config.seed = seed;
  config.terrain = terrain;
  Simulation simulation(config);
  simulation.walk(command);
  for (int i = 0; i < std::lround(seconds / Simulation::tick_s); ++i) simulation.step();
  return {simulation.fall_reason(), simulation.frame().com.head<2>()};
}

class FullBodyTerrainSlope : public ::testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Uphill, FullBodyTerrainSlope, ::testing::Values(0, 90, 180));

TEST_P(FullBodyTerrainSlope, IsWalkedAtAboutTheSpeedOfTheCommand) {
  TerrainParameters terrain;
  terrain.kind = TerrainKind::slope;
  terrain.slope_angle = 5.0 * M_PI / 180.0;
  terrain.uphill_angle = GetParam() * M_PI / 180.0;
  const WalkedTerrain walked = walk(terrain, 20.0);
  EXPECT_EQ(walked.fall, "");
  EXPECT_NEAR(walked.way.norm(), 0.3 * (20.0 - 1.0), 0.1 * 0.3 * (20.0 - 1.0));
}

TEST(FullBodyTerrain, TilesOfTwoCentimetresAreWalkedForAMinute) {
  TerrainParameters terrain;
  terrain.kind = TerrainKind::uneven;
  terrain.unevenness = 0.02;
  for (const std::uint64_t seed : {1, 2}) {
    const WalkedTerrain walked = walk(terrain, 60.0, seed);
    EXPECT_EQ(walked.fall, "") << seed;
    EXPECT_GT(walked.way.norm(), 14.0) << seed;
  }
}

// A step down from a tile comes late, and the DCM runs away meanwhile. With a foot that felt for
// the ground at 0.1 m/s, and went forward while it came up, h1_2 fell in each of these.
TEST(FullBodyTerrain, StepsDownFromTilesAreQuickEnoughForARobotOnLongFeet) {
  const auto h1_2 = load_robot("robots/h1_2");
  TerrainParameters terrain;
  terrain.kind = TerrainKind::uneven;
  terrain.unevenness = 0.0091;
  for (const std::uint64_t seed : {5, 17, 46}) {
    const WalkedTerrain walked = walk(terrain, 20.0, seed, {0.0, 0.0954, 0.0}, h1_2);
    EXPECT_EQ(walked.fall, "") << seed;
    EXPECT_GT(walked.way.y(), 1.3) << seed;
  }
}

// A toe that stands at a tile's edge is held by it when it is lifted. A foot that goes forward
// while it comes up, its sole held with the stiffness of its place, is turned over: h1_2 fell in
// each.
TEST(FullBodyTerrain, ToesComeOffTheEdgesOfTiles) {
  const auto h1_2 = load_robot("robots/h1_2");
  TerrainParameters terrain;
  terrain.kind = TerrainKind::uneven;
  terrain.unevenness = 0.0091;
  for (const std::uint64_t seed : {1, 2, 3, 5}) {
    const WalkedTerrain walked = walk(terrain, 50.0, seed, {0.286, 0.0, 0.0}, h1_2);
    EXPECT_EQ(walked.fall, "") << seed;
    EXPECT_GT(walked.way.x(), 12.0) << seed;
  }
}

// On tiles of 2 cm for its size. h1_2 fell in each when a foot that came late stayed over the place
// that had been right in time, and one that was caught was pulled on; in two of them by the first.
TEST(FullBodyTerrain, AFootThatComesLateGoesAfterTheDcm) {
  const auto h1_2 = load_robot("robots/h1_2");
  TerrainParameters terrain;
  terrain.kind = TerrainKind::uneven;
  terrain.unevenness = 0.0164;
  for (const std::uint64_t seed : {4, 7, 10}) {
    const WalkedTerrain walked = walk(terrain, 60.0, seed, {0.0, 0.1908, 0.0}, h1_2);
    EXPECT_EQ(walked.fall, "") << seed;
    EXPECT_GT(walked.way.norm(), 8.0) << seed;  // an edge may hold it for some steps
  }
}

TEST(FullBodyTerrain, APlatformIsSteppedOnWhileItMovesAndIsShoved) {
  TerrainParameters terrain;
  terrain.kind = TerrainKind::platform;
  terrain.platform_velocity = {0.05, 0.0};
  terrain.shoves = {{4.0, 0.3, Vec2(0.0, 0.03)}};
  EXPECT_EQ(walk(terrain, 10.0, 1, {}).fall, "");
}

TEST(FullBodyTerrain, IsTheSameAgainToTheBit) {
  TerrainParameters terrain;
  terrain.kind = TerrainKind::uneven;
  terrain.unevenness = 0.03;
  terrain.patches = {{Vec2(0.5, -1.0), Vec2(1.0, 1.0), 0.6}};
  const auto hash = [&terrain](std::uint64_t seed) {
    SimulationConfig config;
    config.robot = kasaei();
    config.seed = seed;
    config.terrain = terrain;
    Simulation simulation(config);
    simulation.walk({0.3, 0.0, 0.0});
    for (int i = 0; i < 6000; ++i) simulation.step();
    return simulation.state_hash();
  };
  const std::uint64_t first = hash(1);
  EXPECT_NE(hash(2), first);
  EXPECT_EQ(hash(1), first);
}

TEST(FullBodyTerrain, LegsThatDoNotTouchWalkTheSameWithAndWithoutSelfCollision) {
  const auto hash = [](bool self_collision) {
    SimulationConfig config;
    config.robot = kasaei();
    config.physics.self_collision = self_collision;
    Simulation simulation(config);
    simulation.walk({0.3, 0.0, 0.0});
    for (int i = 0; i < 6000; ++i) simulation.step();
    return simulation.state_hash();
  };
  EXPECT_EQ(hash(true), hash(false));
}

}  // namespace
}  // namespace stagger::sim
