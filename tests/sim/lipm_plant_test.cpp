#include "sim/plant/lipm_plant.h"

#include <gtest/gtest.h>

namespace stagger::sim {
namespace {

class LipmPlantTest : public ::testing::Test {
 protected:
  std::shared_ptr<const Robot> robot = load_robot("robots/kasaei");
  LipmPlant plant{lipm_parameters(*robot), 0.001};
  engine::WalkingTargets standing;  // both feet down, ZMP in the middle
};

TEST_F(LipmPlantTest, RestsOverAZmpInTheMiddle) {
  for (int i = 0; i < 1000; ++i) plant.step(standing, {});
  EXPECT_EQ(plant.measurement().com.head<2>(), Vec2::Zero());
}

TEST_F(LipmPlantTest, APushChangesTheMomentumByItsImpulse) {
  const AppliedForce force{"torso", {}, {300.0, -150.0, 0.0}};
  plant.step(standing, std::span(&force, 1));
  // One tick from rest: w^2 c is of second order in it.
  const Vec2 momentum = robot->model.mass() * plant.measurement().com_velocity.head<2>();
  EXPECT_LT((momentum - Vec2(0.3, -0.15)).norm(), 1e-5);
}

TEST_F(LipmPlantTest, TheZmpCannotLeaveTheFeet) {
  standing.zmp_command = {1.0, 0.0};
  plant.step(standing, {});
  EXPECT_NEAR(plant.measurement().zmp.x(), 0.075, 1e-12);
}

TEST_F(LipmPlantTest, FallsByDivergence) {
  const AppliedForce force{"torso", {}, {60000.0, 0.0, 0.0}};
  plant.step(standing, std::span(&force, 1));
  int ticks = 0;
  while (plant.fall_reason().empty() && ticks < 3000) {
    plant.step(standing, {});
    ++ticks;
  }
  EXPECT_LT(ticks, 3000);
  plant.release();
  const Vec3 where = plant.measurement().com;
  plant.step(standing, {});
  EXPECT_EQ(plant.measurement().com, where);
}

}  // namespace
}  // namespace stagger::sim
