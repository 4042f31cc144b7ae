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

void simulation_tick(benchmark::State& state, PlantKind plant) {
  SimulationConfig config;
  config.robot = kasaei();
  config.plant = plant;
  Simulation simulation(config);
  simulation.walk({});
  for (auto _ : state) benchmark::DoNotOptimize(simulation.step().tick);
  state.counters["x_real_time"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * Simulation::tick_s, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(simulation_tick, bullet, PlantKind::bullet);
BENCHMARK_CAPTURE(simulation_tick, lipm, PlantKind::lipm);

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

/// Standing: the controller and the physics of a tick, one at a time.
struct Standing {
  FullBodyPlant plant{kasaei(), Simulation::tick_s, {}, 1};
  engine::WalkingEngine engine{
      engine_parameters(*kasaei(), PlantKind::bullet, {}, Simulation::tick_s), plant.measurement()};
  RobotState state = nominal_state(*kasaei());
  RigidBody body{kasaei()->model};
  WholeBodyController controller{*kasaei()};
};

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
