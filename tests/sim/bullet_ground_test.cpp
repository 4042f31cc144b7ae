// The terrain as the robot meets it in the physics.
#include "sim/plant/bullet_ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/simulation.h"

namespace stagger::sim {
namespace {

class BulletGroundTest : public ::testing::Test {
 protected:
  /// At rest on the ground at a place, until the first contacts have been solved.
  std::vector<BulletWorld::Contact> contacts_at(const Terrain& terrain, const Vec2& place) {
    RobotState start = nominal_state(*robot_);
    start.base_position.head<2>() += place;
    start.base_position.z() += terrain.height(place) + 1e-4;
    BulletWorld world(robot_->model, start, {}, terrain);
    for (int i = 0; i < 20 && world.contacts().empty(); ++i) {
      world.step(Eigen::VectorXd::Zero(12), {});
    }
    return {world.contacts().begin(), world.contacts().end()};
  }
  /// A robot that stands, not walks, for some seconds.
  Frame standing(const TerrainParameters& terrain, double seconds) {
    SimulationConfig config;
    config.robot = robot_;
    config.terrain = terrain;
    Simulation simulation(config);
    for (int i = 0; i < std::lround(seconds / Simulation::tick_s); ++i) simulation.step();
    return simulation.frame();
  }

  std::shared_ptr<const Robot> robot_ = load_robot("robots/kasaei");
};

TEST_F(BulletGroundTest, TilesAreWhereTheTerrainSaysHoweverFar) {
  TerrainParameters parameters;
  parameters.kind = TerrainKind::uneven;
  parameters.unevenness = 0.03;
  const Terrain terrain(parameters, 3);
  for (const Vec2& place : {Vec2(1.0, 0.5), Vec2(-1.0, 2.0), Vec2(100.5, -37.0)}) {
    const auto contacts = contacts_at(terrain, place);
    ASSERT_FALSE(contacts.empty()) << place.transpose();
    for (const BulletWorld::Contact& contact : contacts) {
      EXPECT_NEAR(contact.point.z(), terrain.height(place), 1e-3) << place.transpose();
    }
  }
}

TEST_F(BulletGroundTest, PatchesAreAsSlipperyAsTheySay) {
  TerrainParameters parameters;
  parameters.friction = 0.7;
  parameters.patches = {{Vec2(-1.0, -1.0), Vec2(1.0, 0.0), 0.2}};  // under the right foot
  RobotState start = nominal_state(*robot_);
  start.base_velocity = Vec3(2.0, 0.0, 0.0);
  BulletWorld world(robot_->model, start, {}, Terrain(parameters));
  for (int i = 0; i < 5; ++i) world.step(Eigen::VectorXd::Zero(12), {});
  ASSERT_FALSE(world.contacts().empty());
  for (const BulletWorld::Contact& contact : world.contacts()) {
    const double friction = contact.point.y() < 0.0 ? 0.2 : 0.7;
    EXPECT_NEAR(contact.force.x(), -friction * contact.force.z(), 0.02 * contact.force.z());
  }
}

TEST_F(BulletGroundTest, ASlopeCarriesARobotThatStands) {
  for (const double uphill : {0.0, M_PI / 2.0, M_PI}) {
    TerrainParameters parameters;
    parameters.kind = TerrainKind::slope;
    parameters.slope_angle = 8.0 * M_PI / 180.0;
    parameters.uphill_angle = uphill;
    const Frame frame = standing(parameters, 3.0);
    EXPECT_FALSE(frame.fallen) << uphill;
    EXPECT_NEAR(frame.foot_load[0] + frame.foot_load[1], 30.0 * 9.81, 3.0) << uphill;
    const Terrain terrain(parameters);
    for (const FootPose& foot : frame.feet) {
      EXPECT_NEAR(foot.position.z(), terrain.height(foot.position.head<2>()), 1e-3) << uphill;
    }
    EXPECT_LT(frame.com.head<2>().norm(), 0.01) << uphill;
  }
}

TEST_F(BulletGroundTest, APlatformTakesTheFeetAlong) {
  TerrainParameters parameters;
  parameters.kind = TerrainKind::platform;
  parameters.platform_velocity = {0.05, 0.03};
  const Frame frame = standing(parameters, 1.5);
  EXPECT_FALSE(frame.fallen);
  const Vec2 way = Terrain(parameters).platform_position(1.5);
  const Vec2 middle = 0.5 * (frame.feet[0].position + frame.feet[1].position).head<2>();
  EXPECT_GT(way.norm(), 0.05);
  EXPECT_NEAR((middle - way).norm(), 0.0, 0.005);
}

TEST_F(BulletGroundTest, AShoveOfThePlatformIsFeltAndSurvived) {
  TerrainParameters parameters;
  parameters.kind = TerrainKind::platform;
  parameters.shoves = {{0.5, 0.3, Vec2(0.02, 0.0)}};
  const Frame frame = standing(parameters, 0.65);
  EXPECT_GT(frame.feet[0].position.x(), 0.008);                // the feet go along
  EXPECT_LT(frame.com.x(), 0.5 * frame.feet[0].position.x());  // the body stays behind
  EXPECT_FALSE(standing(parameters, 3.0).fallen);
}

}  // namespace
}  // namespace stagger::sim
