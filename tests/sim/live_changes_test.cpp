// What can be changed in a world that lives: parameters, step lists; and what it tells of itself.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/simulation.h"
#include "sim/world_command.h"

namespace stagger::sim {
namespace {

SimulationConfig config_of(PlantKind plant) {
  static const auto robot = load_robot("robots/kasaei");
  SimulationConfig config;
  config.robot = robot;
  config.plant = plant;
  return config;
}

void run(Simulation& world, int ticks) {
  for (int i = 0; i < ticks; ++i) world.step();
}

std::vector<Event> of_kind(const std::vector<Event>& events, EventKind kind) {
  std::vector<Event> found;
  std::copy_if(events.begin(), events.end(), std::back_inserter(found),
               [kind](const Event& event) { return event.kind == kind; });
  return found;
}

double value_of(const Event& event, const std::string& name) {
  for (const auto& [key, value] : event.values) {
    if (key == name) return value;
  }
  ADD_FAILURE() << "no value " << name;
  return 0.0;
}

TEST(LiveParameters, ChangeWithAStepAndSaySo) {
  Simulation world(config_of(PlantKind::lipm));
  world.walk({});
  run(world, 3000);
  world.take_events();
  const std::uint64_t landed = world.frame().step_count;
  world.set_parameters({{"gait.t_ss", 0.6}, {"lipm.noise", 0.01}});
  EXPECT_TRUE(world.active_parameters().empty());
  EXPECT_EQ(world.config().parameters, (ParameterValues{{"gait.t_ss", 0.6}}));
  run(world, 3000);
  EXPECT_EQ(world.active_parameters(), (ParameterValues{{"gait.t_ss", 0.6}}));
  const auto told = of_kind(world.take_events(), EventKind::parameters);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(value_of(told[0], "gait.t_ss"), 0.6);
  EXPECT_EQ(world.frame().t_ss, 0.6);
  EXPECT_GT(world.frame().step_count, landed + 3);
  EXPECT_LT(world.worst_dcm_error(), 0.02);
  EXPECT_THROW(world.set_parameters({{"gait.t_ss", 60.0}}), std::invalid_argument);
  EXPECT_EQ(world.config().parameters, (ParameterValues{{"gait.t_ss", 0.6}}));
  world.set_parameters({});
  run(world, 3000);
  EXPECT_EQ(world.frame().t_ss, 0.36);
}

TEST(LiveParameters, ChangeOfAFullBodyThatWalks) {
  Simulation world(config_of(PlantKind::bullet));
  world.walk({});
  run(world, 1500);
  world.set_parameters({{"gait.t_ss", 0.42},
                        {"gait.swing_height", 0.05},
                        {"body.torso_stiffness", 400.0},
                        {"lqg.zmp_weight", 14.0}});
  run(world, 3000);
  EXPECT_TRUE(world.fall_reason().empty()) << world.fall_reason();
  EXPECT_EQ(world.active_parameters().size(), 4U);
}

TEST(LiveSteps, AreWalkedInTheTrueWorldAndRefusedByNumber) {
  for (const PlantKind plant : {PlantKind::lipm, PlantKind::bullet}) {
    Simulation world(config_of(plant));
    run(world, 500);
    const double half = 0.5 * (world.frame().feet[0].position - world.frame().feet[1].position).y();
    const std::vector<Footstep> steps{{{0.15, -half}, 0.0, Side::right},
                                      {{0.3, half}, 0.0, Side::left},
                                      {{0.3, -half}, 0.0, Side::right}};
    apply(world, FollowSteps{steps});
    run(world, 5000);
    EXPECT_TRUE(world.fall_reason().empty());
    EXPECT_EQ(world.frame().state, WalkingState::idle);
    EXPECT_EQ(world.frame().step_count, 3U);
    const double tolerance = plant == PlantKind::lipm ? 1e-3 : 0.03;
    EXPECT_NEAR(world.frame().feet[0].position.x(), 0.3, tolerance);
    EXPECT_NEAR(world.frame().feet[1].position.x(), 0.3, tolerance);

    std::vector<Footstep> far = steps;
    for (Footstep& step : far) step.position.x() += 0.3;
    far[1].position.x() += 3.0;
    try {
      world.follow(far);
      ADD_FAILURE() << "taken";
    } catch (const StepListRefused& refused) {
      EXPECT_EQ(refused.step, 1U);
    }
    world.walk({});
    run(world, 100);
    try {
      world.follow(steps);
      ADD_FAILURE() << "taken";
    } catch (const StepListRefused& refused) {
      EXPECT_FALSE(refused.step);
    }
  }
}

TEST(LiveEvents, TellOfStepsThatWereAdjustedAndOfNoOthers) {
  Simulation world(config_of(PlantKind::lipm));
  world.walk({.vx = 0.2});
  run(world, 6000);
  EXPECT_TRUE(of_kind(world.take_events(), EventKind::adjustment).empty());
  PushSpec push;
  push.impulse_ns = 12.0;
  push.direction = Vec3::UnitY();
  push.duration_s = 0.05;
  world.push(push);
  run(world, 3000);
  const auto events = world.take_events();
  const auto adjusted = of_kind(events, EventKind::adjustment);
  ASSERT_FALSE(adjusted.empty());
  EXPECT_LT(adjusted.size(), of_kind(events, EventKind::step).size());
  const Event& first = adjusted.front();
  const double moved = std::hypot(value_of(first, "adjusted_x") - value_of(first, "planned_x"),
                                  value_of(first, "adjusted_y") - value_of(first, "planned_y"));
  EXPECT_NEAR(moved, value_of(first, "moved_m"), 1e-9);
  EXPECT_TRUE(moved > told_adjustment_m ||
              std::abs(value_of(first, "t_ss") - value_of(first, "planned_t_ss")) >
                  told_adjustment_s);
  EXPECT_NEAR(value_of(first, "planned_t_ss"), 0.36, 1e-9);
}

TEST(LiveEvents, TellOfStrategies) {
  Simulation world(config_of(PlantKind::lipm));
  world.set_strategies({});
  EXPECT_TRUE(world.take_events().empty());
  world.set_strategies({.ankle = true, .hip = false, .step = true, .time = true});
  const auto told = of_kind(world.take_events(), EventKind::strategies);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].text, "may act: ankle step time");
}

}  // namespace
}  // namespace stagger::sim
