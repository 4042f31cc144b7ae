#include "sim/simulation.h"

#include <gtest/gtest.h>

#include "tests/sim/kasaei.h"

namespace stagger::sim {
namespace {

Simulation make(PlantKind plant) {
  SimulationConfig config;
  config.robot = kasaei();
  config.plant = plant;
  return Simulation(config);
}

PushSpec push_of(double impulse, double duration) {
  PushSpec spec;
  spec.impulse_ns = impulse;
  spec.duration_s = duration;
  return spec;
}

void run(Simulation& simulation, double seconds) {
  for (int i = 0; i < std::lround(seconds / Simulation::tick_s); ++i) simulation.step();
}

class EachPlant : public ::testing::TestWithParam<PlantKind> {};

INSTANTIATE_TEST_SUITE_P(Plants, EachPlant, ::testing::Values(PlantKind::bullet, PlantKind::lipm),
                         [](const auto& plant) {
                           return plant.param == PlantKind::bullet ? "bullet" : "lipm";
                         });

TEST_P(EachPlant, StandsUntilItWalks) {
  Simulation simulation = make(GetParam());
  run(simulation, 1.0);
  EXPECT_EQ(simulation.frame().state, WalkingState::idle);
  simulation.walk({});
  simulation.step();
  EXPECT_EQ(simulation.frame().state, WalkingState::initialize);
  EXPECT_EQ(simulation.frame().tick, 1000U);
}

TEST_P(EachPlant, TellsOfTheGroundsForces) {
  Simulation simulation = make(GetParam());
  simulation.walk({});
  int in_swing = 0;
  for (int i = 0; i < 2000; ++i) {
    const Frame& frame = simulation.step();
    if (i < 10) continue;
    double load = 0.0;
    for (std::size_t k = 0; k < frame.ground_force_count; ++k) {
      load += frame.ground_forces[k].force.z();
    }
    EXPECT_NEAR(load, frame.foot_load[0] + frame.foot_load[1], 1e-6);
    if (frame.state == WalkingState::single_support) ++in_swing;
    EXPECT_EQ(frame.reachable_footholds.count > 0, frame.state == WalkingState::single_support);
  }
  EXPECT_GT(in_swing, 100);
}

TEST_P(EachPlant, TellsOfStepsAndPushes) {
  Simulation simulation = make(GetParam());
  simulation.walk({});
  run(simulation, 2.0);
  int steps = 0;
  for (const Event& event : simulation.take_events()) steps += event.kind == EventKind::step;
  EXPECT_EQ(steps, static_cast<int>(simulation.frame().step_count));
  EXPECT_GT(steps, 1);

  simulation.push(push_of(3.0, 0.05));
  run(simulation, 0.1);
  bool started = false;
  bool done = false;
  for (const Event& event : simulation.take_events()) {
    if (event.kind == EventKind::push_started) {
      started = true;
      EXPECT_EQ(event.tick, 2000U);
    }
    done = done || event.kind == EventKind::push_done;
  }
  EXPECT_TRUE(started);
  EXPECT_TRUE(done);
  EXPECT_NEAR(simulation.pushes()[0].delivered.norm(), 3.0, 1e-9);
}

TEST_P(EachPlant, APushIsInTheFramesWhileItActs) {
  Simulation simulation = make(GetParam());
  simulation.push(push_of(1.0, 0.02));
  double impulse = 0.0;
  for (int i = 0; i < 100; ++i) impulse += simulation.step().push_force.x() * Simulation::tick_s;
  EXPECT_NEAR(impulse, 1.0, 1e-9);
}

TEST_P(EachPlant, FallsFromAPushThatIsTooHard) {
  Simulation simulation = make(GetParam());
  simulation.walk({});
  run(simulation, 2.0);
  simulation.push(push_of(120.0, 0.1));
  run(simulation, 4.0);
  EXPECT_FALSE(simulation.fall_reason().empty());
  EXPECT_TRUE(simulation.frame().fallen);
  int falls = 0;
  for (const Event& event : simulation.take_events()) falls += event.kind == EventKind::fall;
  EXPECT_EQ(falls, 1);
  run(simulation, 1.0);  // lies there without exploding
  EXPECT_LT(simulation.frame().com.norm(), 20.0);
}

TEST_P(EachPlant, RepeatsToTheBit) {
  const auto hash = [] {
    Simulation simulation = make(GetParam());
    simulation.walk({0.2, 0.0, 0.1});
    run(simulation, 2.0);
    simulation.push(push_of(4.0, 0.05));
    run(simulation, 1.0);
    return simulation.state_hash();
  };
  EXPECT_EQ(hash(), hash());
}

TEST_P(EachPlant, RefusesAPushOnALinkThatIsNotThere) {
  Simulation simulation = make(GetParam());
  PushSpec spec = push_of(1.0, 0.1);
  spec.link = "tail";
  EXPECT_THROW(simulation.push(spec), std::invalid_argument);
}

}  // namespace
}  // namespace stagger::sim
