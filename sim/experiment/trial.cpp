#include "sim/experiment/trial.h"

#include <algorithm>
#include <cmath>

#include "sim/experiment/push_train.h"
#include "sim/simulation.h"

namespace stagger::sim {
namespace {

std::uint64_t ticks_of(double seconds) {
  return static_cast<std::uint64_t>(std::llround(seconds / Simulation::tick_s));
}

}  // namespace

TrialResult run_trial(const TrialSpec& spec, std::shared_ptr<const Robot> robot) {
  SimulationConfig config;
  config.robot = std::move(robot);
  config.plant = spec.plant;
  config.seed = spec.seed;
  config.strategies = spec.strategies;
  config.senses = spec.senses;
  config.terrain = spec.terrain;
  config.physics.self_collision = spec.self_collision;
  config.parameters = spec.parameters;
  Simulation simulation(std::move(config));
  if (!spec.stand) simulation.walk(spec.walk);
  TrialResult result;

  const auto finish = [&](TrialOutcome outcome, std::string reason) {
    result.outcome = outcome;
    result.reason = std::move(reason);
    result.worst_dcm_error_m = simulation.worst_dcm_error();
    result.ticks = simulation.next_tick();
    result.state_hash = simulation.state_hash();
    return result;
  };
  const auto fell = [&] { return !simulation.fall_reason().empty(); };

  const std::uint64_t settle = ticks_of(spec.settle_s);
  while (simulation.next_tick() < settle && !fell()) simulation.step();
  if (fell()) {
    result.fall_time_s = simulation.frame().time;
    return finish(TrialOutcome::invalid, "before the push: " + simulation.fall_reason());
  }
  simulation.take_events();

  const std::vector<PushSpec> one = spec.push ? std::vector{*spec.push} : std::vector<PushSpec>{};
  PushTrain train(spec.push ? one : spec.pushes, spec.stand);
  const auto look_back = [&] {
    result.push_tick = train.first_tick();
    result.delivered_ns = train.delivered_ns();
    if (!spec.push) result.pushes = train.outcomes(fell());
  };
  while (!train.done() && !fell()) {
    train.schedule(simulation);
    if (train.overdue(simulation.next_tick())) {
      look_back();
      return finish(TrialOutcome::timeout, "the push's trigger never came");
    }
    train.step(simulation);
  }
  if ((spec.push || !spec.pushes.empty()) && !train.first_tick()) {
    look_back();
    result.fall_time_s = simulation.frame().time;
    return finish(TrialOutcome::invalid, "before the push: " + simulation.fall_reason());
  }

  const std::uint64_t start = simulation.next_tick();
  const std::uint64_t end = start + ticks_of(spec.observe_s);
  while (simulation.next_tick() < end && !fell()) train.step(simulation);
  look_back();
  if (fell()) {
    result.fall_time_s = simulation.frame().time;
    return finish(TrialOutcome::fell, simulation.fall_reason());
  }
  result.steps_to_recover = train.recovery().steps();
  if (const auto back = train.recovery().back_tick()) {
    result.recovery_time_s =
        static_cast<double>(std::max(*back, start) - start) * Simulation::tick_s;
  }
  return finish(TrialOutcome::recovered, {});
}

}  // namespace stagger::sim
