// Where a tick's time goes: engine alone, point mass, full body, and the full body's parts.
#include <benchmark/benchmark.h>
#include <malloc.h>

#include "engine/walking_engine.h"
#include "sim/engine_setup.h"
#include "sim/plant/full_body_plant.h"
#include "sim/plant/lipm_plant.h"
#include "sim/simulation.h"
#include "tests/sim/kasaei.h"

namespace stagger::sim {
namespace {

SimulationConfig config_of(PlantKind plant, TerrainKind terrain = TerrainKind::flat) {
  SimulationConfig config;
  config.robot = kasaei();
  config.plant = plant;
  config.terrain.kind = terrain;
  config.terrain.unevenness = 0.01;
  return config;
}

SimulationConfig without_self_collision() {
  SimulationConfig config = config_of(PlantKind::bullet);
  config.physics.self_collision = false;
  return config;
}

SimulationConfig with_perfect_state() {
  SimulationConfig config = config_of(PlantKind::bullet);
  config.senses.perfect_state = true;
  return config;
}

void simulation_tick(benchmark::State& state, const SimulationConfig& config) {
  Simulation simulation(config);
  simulation.walk({});
  for (auto _ : state) benchmark::DoNotOptimize(simulation.step().tick);
  state.counters["x_real_time"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * Simulation::tick_s, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(simulation_tick, bullet, config_of(PlantKind::bullet));
BENCHMARK_CAPTURE(simulation_tick, bullet_perfect_state, with_perfect_state());
BENCHMARK_CAPTURE(simulation_tick, bullet_legs_pass_through, without_self_collision());
BENCHMARK_CAPTURE(simulation_tick, bullet_uneven,
                  config_of(PlantKind::bullet, TerrainKind::uneven));
BENCHMARK_CAPTURE(simulation_tick, lipm, config_of(PlantKind::lipm));

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

/// A trial's world, and what it holds of the heap.
void world_construction(benchmark::State& state, TerrainKind terrain) {
  const SimulationConfig config = config_of(PlantKind::bullet, terrain);
  for (auto _ : state) benchmark::DoNotOptimize(Simulation(config));
  const auto held = [] {
    const struct mallinfo2 heap = mallinfo2();
    return static_cast<double>(heap.uordblks + heap.hblkhd);
  };
  const double before = held();
  Simulation simulation(config);
  simulation.walk({});
  for (int i = 0; i < 1000; ++i) simulation.step();
  state.counters["MB"] = (held() - before) / 1e6;
}
BENCHMARK_CAPTURE(world_construction, flat, TerrainKind::flat)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(world_construction, uneven, TerrainKind::uneven)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(world_construction, platform, TerrainKind::platform)
    ->Unit(benchmark::kMicrosecond);

// The parts of the full body's tick beside the engine, one at a time, standing: physics, state
// estimate, control.

struct Standing {
  FullBodyPlant plant{kasaei(), {}, {}, 1};
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
