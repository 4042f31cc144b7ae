// One tick of the engine, both axes, planning included: median, and the worst of a million.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "engine/walking_engine.h"
#include "sim/plant/lipm_plant.h"

namespace stagger::engine {
namespace {

/// Ticks of a robot that walks and is pushed every five seconds; all strategies on.
void tick(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  constexpr double dt = 0.002;
  Parameters p;
  p.hip.torque = 60.0;
  p.step_margin = 0.01;
  p.measurement_noise = 1e-10;
  sim::LipmParameters truth;
  truth.hip = p.hip;
  sim::LipmPlant plant(truth, dt);
  WalkingEngine engine(p, plant.measurement());
  engine.walk({0.2, 0.0, 0.0});
  std::vector<double> nanoseconds;
  nanoseconds.reserve(1000000);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto start = Clock::now();
    const WalkingTargets& targets = engine.update(plant.measurement());
    const std::chrono::duration<double> took = Clock::now() - start;
    state.SetIterationTime(took.count());
    if (nanoseconds.size() < nanoseconds.capacity()) nanoseconds.push_back(took.count() * 1e9);
    std::vector<sim::AppliedForce> forces;
    if (i % 2500 < 5) forces.push_back({"", {}, {400.0, 100.0, 0.0}});
    plant.step(targets, forces);
    ++i;
  }
  std::sort(nanoseconds.begin(), nanoseconds.end());
  state.counters["median_ns"] = nanoseconds[nanoseconds.size() / 2];
  state.counters["p99_ns"] = nanoseconds[nanoseconds.size() * 99 / 100];
  state.counters["worst_ns"] = nanoseconds.back();
  state.counters["up"] = plant.fall_reason().empty() ? 1.0 : 0.0;
}
BENCHMARK(tick)->UseManualTime()->Iterations(1000000);

}  // namespace
}  // namespace stagger::engine
