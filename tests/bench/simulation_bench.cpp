// Where a tick's time goes: engine alone, point mass, full body, and the full body's parts.
#include <benchmark/benchmark.h>

#include "engine/walking_engine.h"
#include "sim/engine_setup.h"
#include "sim/plant/full_body_plant.h"
#include "sim/plant/lipm_plant.h"
#include "sim/simulation.h"

namespace stagger::sim {
namespace {

std::shared_ptr<const Robot> kasaei() {
  static const std::shared_ptr<const Robot> robot = load_robot("robots/kasaei");
  return robot;
}

void simulation_tick(benchmark::State& state, PlantKind plant, bool perfect_state) {
  SimulationConfig config;
  config.robot = kasaei();
  config.plant = plant;
  config.senses.perfect_state = perfect_state;
  Simulation simulation(config);
  simulation.walk({});
  for (auto _ : state) benchmark::DoNotOptimize(simulation.step().tick);
  state.counters["x_real_time"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * Simulation::tick_s, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(simulation_tick, bullet, PlantKind::bullet, false);
BENCHMARK_CAPTURE(simulation_tick, bullet_perfect_state, PlantKind::bullet, true);
BENCHMARK_CAPTURE(simulation_tick, lipm, PlantKind::lipm, true);

void engine_tick(benchmark::State& state) {
  LipmPlant plant(lipm_parameters(*kasaei()), Simulation::tick_s);
  engine::WalkingEngine engine(
      engine_parameters(*kasaei(), PlantKind::lipm, {}, Simulation::tick_s), plant.measurement());
  engine.walk({});
  for (auto _ : state) {
    benchmark::DoNotOptimize(engine.update(plant.measurement()).zmp_command);
    state.PauseTiming();
    plant.step(engine.targets(), {});
    state.ResumeTiming();
  }
}
BENCHMARK(engine_tick);

void world_construction(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(FullBodyPlant(kasaei(), Simulation::tick_s, {}, 1));
}
BENCHMARK(world_construction)->Unit(benchmark::kMicrosecond);

// The parts of the full body's tick beside the engine, one at a time, standing: physics, state
// estimate, control.

struct Standing {
  FullBodyPlant plant{kasaei(), Simulation::tick_s, {}, 1};
  engine::WalkingEngine engine{
      engine_parameters(*kasaei(), PlantKind::bullet, {}, Simulation::tick_s), plant.measurement()};
  RobotState state = nominal_state(*kasaei());
  RigidBody body{kasaei()->model};
  WholeBodyController controller{*kasaei()};
};

void physics_step(benchmark::State& state) {
  BulletWorld world(kasaei()->model, nominal_state(*kasaei()), {});
  Standing standing;
  for (auto _ : state) {
    state.PauseTiming();
    standing.body.update(world.state());
    const Eigen::VectorXd& torque = standing.controller.compute(
        standing.body, world.state(), standing.engine.update(standing.plant.measurement()));
    state.ResumeTiming();
    world.step(torque, {});
  }
}
BENCHMARK(physics_step);

/// Both feet stand: the most that there is to update.
struct Sensing {
  static constexpr double gravity = 9.81;
  RobotState state = nominal_state(*kasaei());
  SensorParameters parameters;
  Sensors sensors{*kasaei(), parameters, 1, Simulation::tick_s, gravity, state};
  Estimator estimator{*kasaei(), parameters, Simulation::tick_s, gravity, state};
  PerFoot<SoleLoad> loads{SoleLoad{147.0, Vec2::Zero()}, SoleLoad{147.0, Vec2::Zero()}};
};

void sensor_readings(benchmark::State& state) {
  Sensing sensing;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sensing.sensors.read(sensing.state, sensing.loads).specific_force);
  }
}
BENCHMARK(sensor_readings);

void state_estimate(benchmark::State& state) {
  Sensing sensing;
  const SensorReadings& readings = sensing.sensors.read(sensing.state, sensing.loads);
  for (auto _ : state) {
    sensing.estimator.update(readings);
    benchmark::DoNotOptimize(sensing.estimator.state().base_position);
  }
}
BENCHMARK(state_estimate);

void whole_body_control(benchmark::State& state) {
  Standing standing;
  standing.body.update(standing.state);
  const auto& targets = standing.engine.update(standing.plant.measurement());
  for (auto _ : state) {
    benchmark::DoNotOptimize(standing.controller.compute(standing.body, standing.state, targets));
  }
}
BENCHMARK(whole_body_control);

void rigid_body_update(benchmark::State& state) {
  Standing standing;
  for (auto _ : state) {
    standing.body.update(standing.state);
    benchmark::DoNotOptimize(standing.body.bias());
  }
}
BENCHMARK(rigid_body_update);

}  // namespace
}  // namespace stagger::sim
