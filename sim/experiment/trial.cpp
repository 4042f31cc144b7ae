#include "sim/experiment/trial.h"

#include <algorithm>
#include <cmath>

#include "sim/experiment/recovery.h"
#include "sim/simulation.h"

namespace stagger::sim {
namespace {

/// How long a push may wait for its phase or time beyond the settling [s].
constexpr double trigger_patience_s = 10.0;

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

  Recovery recovery(spec.stand);
  const auto step = [&] { recovery.look(simulation.step()); };
  if (spec.push) {
    simulation.push(*spec.push);
    // Safe to hold on to: this simulation gets no second push.
    const PushRecord& push = simulation.pushes().back();
    double patience = trigger_patience_s;
    if (const auto* at = std::get_if<TimeTrigger>(&spec.push->trigger)) patience += at->at_s;
    const std::uint64_t latest = settle + ticks_of(patience);
    while (!push.start_tick && !fell()) {
      if (simulation.next_tick() >= latest) {
        return finish(TrialOutcome::timeout, "the push's trigger never came");
      }
      simulation.take_events();
      simulation.step();
    }
    if (!push.start_tick) {
      result.fall_time_s = simulation.frame().time;
      return finish(TrialOutcome::invalid, "before the push: " + simulation.fall_reason());
    }
    result.push_tick = push.start_tick;
    while (push.state == PushState::active && !fell()) step();
    result.delivered_ns = push.delivered.norm();
  }

  const std::uint64_t start = simulation.next_tick();
  const std::uint64_t end = start + ticks_of(spec.observe_s);
  while (simulation.next_tick() < end && !fell()) step();
  recovery.take(simulation.take_events());
  if (fell()) {
    result.fall_time_s = simulation.frame().time;
    return finish(TrialOutcome::fell, simulation.fall_reason());
  }
  result.steps_to_recover = recovery.steps();
  if (const auto back = recovery.back_tick()) {
    result.recovery_time_s =
        static_cast<double>(std::max(*back, start) - start) * Simulation::tick_s;
  }
  return finish(TrialOutcome::recovered, {});
}

}  // namespace stagger::sim
