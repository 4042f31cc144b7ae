#include "sim/engine_setup.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stagger::sim {
namespace {

engine::Parameters parameters_of(const std::string& robot, PlantKind plant = PlantKind::bullet) {
  return engine_parameters(*load_robot("robots/" + robot), plant, {}, 0.001);
}

TEST(EngineSetup, MarginsScaleWithTheRobot) {
  const engine::Parameters defaults;
  for (const char* name : {"kasaei", "op3", "g1", "h1_2"}) {
    const engine::Parameters p = parameters_of(name);
    const double length = p.com_height;  // the reference robot's is 1 m
    EXPECT_NEAR(p.step_freeze, defaults.step_freeze * std::sqrt(length), 1e-12) << name;
    EXPECT_NEAR(p.time_limit, 0.75 * p.t_ss, 1e-12) << name;
    EXPECT_NEAR(p.least_t_ss, defaults.least_t_ss * std::sqrt(length), 1e-12) << name;
    EXPECT_NEAR(p.foot_clearance, defaults.foot_clearance * length, 1e-12) << name;
    EXPECT_NEAR(p.contact_load / (p.mass * p.gravity), 20.0 / (30.0 * 9.81), 1e-9) << name;
    EXPECT_NO_THROW(engine::validate(p)) << name;
  }
  EXPECT_NEAR(parameters_of("h1_2").mass, 66.98, 0.01);
}

TEST(EngineSetup, TheZmpStaysWhereTheAnkleCanHoldIt) {
  // 60 N m hold 67 kg 0.091 m from the ankle, which is 0.044 m behind the sole's centre; the sole
  // would go on to 0.13 m from there.
  EXPECT_NEAR(parameters_of("h1_2").ankle_reach.x(), 0.0473, 5e-4);
  // 40 N m sideways hold it beyond the sole's edge.
  EXPECT_NEAR(parameters_of("h1_2").ankle_reach.y(), 0.0609, 5e-4);
  EXPECT_GT(parameters_of("h1_2").ankle_reach.y(), 0.5 * 0.085);
  EXPECT_NEAR(parameters_of("g1").ankle_reach.x(), 0.0761, 5e-4);
  // The paper's robot can stand on its toes.
  EXPECT_NEAR(parameters_of("kasaei").ankle_reach.x(), 120.0 / (30.0 * 9.81), 1e-6);
}

TEST(EngineSetup, APointMassHasNoAnkles) {
  EXPECT_GT(parameters_of("h1_2", PlantKind::lipm).ankle_reach.x(), 1.0);
}

}  // namespace
}  // namespace stagger::sim
