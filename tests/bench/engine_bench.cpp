// One whole tick of the engine: both axes, all strategies on, planning included. A million of them,
// of a robot that walks a curve and is pushed from another side every five seconds.
//   STAGGER_BENCH_TICKS=N  so many ticks instead
#include <benchmark/benchmark.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <thread>
#include <vector>

#include "engine/walking_engine.h"
#include "sim/plant/lipm_plant.h"
#include "tests/engine/call_counts.h"

namespace stagger::engine {
namespace {

using Clock = std::chrono::steady_clock;

/// What a tick may take at worst.
constexpr double budget_ns = 50000.0;

double nanoseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::nano>(duration).count();
}

std::int64_t ticks_wanted() {
  const char* text = std::getenv("STAGGER_BENCH_TICKS");
  const std::int64_t ticks = text != nullptr ? std::atoll(text) : 0;
  return ticks > 0 ? ticks : 1000000;
}

/// Of sorted values: the least that this share of them does not exceed.
double quantile(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[rank > 0 ? rank - 1 : 0];
}

/// What two looks at the clock take with nothing between them: part of every figure here.
double clock_ns() {
  std::vector<double> times(100001);
  for (double& time : times) {
    const auto start = Clock::now();
    time = nanoseconds(Clock::now() - start);
  }
  std::sort(times.begin(), times.end());
  return quantile(times, 0.5);
}

/// As a controller on a robot runs: memory stays in, nothing of an ordinary kind gets in between.
/// What is not permitted is left out, and the counters tell.
class RealTime {
 public:
  RealTime() {
    locked_ = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
    sched_param lowest{};
    lowest.sched_priority = sched_get_priority_min(SCHED_FIFO);
    fifo_ = sched_setscheduler(0, SCHED_FIFO, &lowest) == 0;
  }
  ~RealTime() {
    const sched_param none{};
    if (fifo_) sched_setscheduler(0, SCHED_OTHER, &none);
    if (locked_) munlockall();
  }
  RealTime(const RealTime&) = delete;
  RealTime& operator=(const RealTime&) = delete;

  bool locked() const { return locked_; }
  bool fifo() const { return fifo_; }

 private:
  bool locked_ = false;
  bool fifo_ = false;
};

/// How often something else ran instead of this thread, against its will.
std::int64_t preemptions() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

void tick(benchmark::State& state) {
  constexpr double dt = 0.002;
  constexpr std::size_t between_pushes = 2500;
  constexpr std::size_t push_ticks = 14;
  constexpr std::array<std::array<double, 2>, 4> pushes{
      {{400.0, 100.0}, {-300.0, 200.0}, {100.0, -300.0}, {-400.0, -100.0}}};  // [N]
  Parameters p;
  p.t_ss = 0.4;
  p.t_ds = 0.1;
  p.hip.torque = 60.0;
  p.step_margin = 0.01;
  p.measurement_noise = 1e-10;
  sim::LipmParameters truth;
  truth.hip = p.hip;
  sim::LipmPlant plant(truth, dt);
  WalkingEngine engine(p, plant.measurement());
  engine.walk({0.2, 0.05, 0.1});

  const double clock = clock_ns();
  // Written to once before it is used: a first write would fetch a page.
  std::vector<double> times(static_cast<std::size_t>(state.max_iterations), 1.0);
  std::vector<sim::AppliedForce> forces;
  std::size_t allocations = 0;
  std::size_t hip_ticks = 0;
  std::size_t moved_steps = 0;
  const RealTime real_time;
  const std::int64_t preemptions_before = preemptions();
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t allocations_before = testing::call_counts().allocations;
    const auto start = Clock::now();
    const WalkingTargets& targets = engine.update(plant.measurement());
    const auto took = Clock::now() - start;
    allocations += testing::call_counts().allocations - allocations_before;
    state.SetIterationTime(std::chrono::duration<double>(took).count());
    times[i] = nanoseconds(took);

    hip_ticks += targets.zmp_shift.norm() > 0.1 ? 1 : 0;
    moved_steps += targets.planned_step.position != targets.adjusted_step.position ? 1 : 0;
    forces.clear();
    if (i >= between_pushes && i % between_pushes < push_ticks) {
      const auto& push = pushes[i / between_pushes % pushes.size()];
      forces.push_back({"", {}, {push[0], push[1], 0.0}});
    }
    plant.step(targets, forces);
    ++i;
    // Linux stops a real-time thread that leaves less than a twentieth of a second to the others.
    if (i % 1000 == 0) std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  const std::int64_t preempted = preemptions() - preemptions_before;
  const auto over =
      std::count_if(times.begin(), times.end(), [](double t) { return t > budget_ns; });
  std::sort(times.begin(), times.end());
  auto& counters = state.counters;
  counters["median_ns"] = quantile(times, 0.5);
  counters["p99_ns"] = quantile(times, 0.99);
  counters["p99.9_ns"] = quantile(times, 0.999);
  counters["worst_ns"] = times.back();
  counters["over_50us"] = static_cast<double>(over);
  counters["clock_ns"] = clock;
  counters["allocations"] = static_cast<double>(allocations);
  counters["preempted"] = static_cast<double>(preempted);
  counters["fifo"] = real_time.fifo() ? 1.0 : 0.0;
  counters["locked"] = real_time.locked() ? 1.0 : 0.0;
  // That there was something to do.
  counters["steps"] = static_cast<double>(engine.targets().step_count);
  counters["moved_steps"] = static_cast<double>(moved_steps);
  counters["hip_ticks"] = static_cast<double>(hip_ticks);
  counters["up"] = plant.fall_reason().empty() ? 1.0 : 0.0;
}
BENCHMARK(tick)->UseManualTime()->Iterations(ticks_wanted());

}  // namespace
}  // namespace stagger::engine
