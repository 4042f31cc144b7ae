#include "sim/plant/full_body_plant.h"

#include <gtest/gtest.h>

#include "engine/walking_engine.h"
#include "sim/engine_setup.h"
#include "tests/sim/tick.h"

namespace stagger::sim {
namespace {

/// Torques of the joints in the ticks of a robot that begins to walk.
std::vector<std::vector<double>> torques(double control_delay, int ticks) {
  const auto robot = load_robot("robots/kasaei");
  SenseParameters senses;
  senses.perfect_state = true;
  senses.control_delay = control_delay;
  FullBodyPlant plant(robot, PhysicsParameters{.dt = dt}, senses, 1);
  engine::WalkingEngine engine(engine_parameters(*robot, PlantKind::bullet, {}, dt, senses),
                               plant.measurement());
  engine.walk({});
  std::vector<std::vector<double>> result;
  Frame frame;
  for (int i = 0; i < ticks; ++i) {
    plant.step(engine.update(plant.measurement()), {});
    plant.describe(frame);
    result.emplace_back(
        frame.joint_torque.begin(),
        frame.joint_torque.begin() + static_cast<std::ptrdiff_t>(frame.joint_count));
  }
  return result;
}

TEST(FullBodyPlantBullet, ADelayedTorqueIsThatOfTheTicksBefore) {
  const auto at_once = torques(0.0, 2);
  const auto late = torques(0.003, 5);
  // The first command holds until the next one arrives; the state is the same until then.
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(late[i], at_once[0]) << i;
  EXPECT_EQ(late[4], at_once[1]);
  EXPECT_NE(at_once[1], at_once[0]);
}

TEST(FullBodyPlantBullet, RefusesSensesThatAreNotValid) {
  const auto robot = load_robot("robots/kasaei");
  SenseParameters senses;
  senses.control_delay = 0.02;
  EXPECT_THROW(FullBodyPlant(robot, PhysicsParameters{.dt = dt}, senses, 1), std::invalid_argument);
}

TEST(FullBodyPlantBullet, PerfectSensesTellTheTruth) {
  const auto robot = load_robot("robots/kasaei");
  for (const bool perfect : {true, false}) {
    SenseParameters senses;
    senses.perfect_state = perfect;
    FullBodyPlant plant(robot, PhysicsParameters{.dt = dt}, senses, 1);
    engine::WalkingEngine engine(engine_parameters(*robot, PlantKind::bullet, {}, dt, senses),
                                 plant.measurement());
    for (int i = 0; i < 100; ++i) plant.step(engine.update(plant.measurement()), {});
    Frame frame;
    plant.describe(frame);
    EXPECT_EQ(plant.measurement().com == frame.com, perfect);
    EXPECT_NEAR((plant.measurement().com - frame.com).norm(), 0.0, 0.01);
    EXPECT_EQ(plant.measurement().foot_load == frame.foot_load, perfect);
    EXPECT_NEAR(plant.measurement().foot_load[0], frame.foot_load[0], 0.05 * 30.0 * 9.81);
  }
}

}  // namespace
}  // namespace stagger::sim
