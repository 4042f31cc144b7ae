#include "sim/experiment/paper/standing.h"

#include <cmath>

#include "sim/experiment/parallel.h"

namespace stagger::sim {
namespace {

constexpr double settle_s = 2.0;
constexpr double stay_s = 3.0;
constexpr double at_rest_m = 0.01;
constexpr double at_rest_ms = 0.03;

ClosedLoop on_one_foot(double position, double velocity, const StandingSetup& setup) {
  engine::Parameters parameters = paper_parameters(setup.noise);
  parameters.hip = setup.hip;
  parameters.strategies.hip = setup.hip.torque > 0.0;
  parameters.strategies.step = parameters.strategies.time = false;
  LipmParameters truth = paper_plant(setup.noise, setup.seed, setup.error);
  truth.hip = setup.hip;
  // Both feet in one place are one foot: idle, the engine stands on it.
  truth.stance_width = 0.0;
  return ClosedLoop(parameters, truth, Vec2(position, 0.0), Vec2(velocity, 0.0));
}

double true_frequency(const StandingSetup& setup) {
  const LipmParameters truth = paper_plant(setup.noise, setup.seed, setup.error);
  return std::sqrt(truth.gravity / truth.com_height);
}

}  // namespace

double standing_bound(const StandingSetup& setup) {
  const LipmParameters truth = paper_plant(setup.noise, setup.seed, setup.error);
  const engine::HipParameters& hip = setup.hip;
  double bound = truth.sole.half_length;
  if (hip.torque > 0.0) {
    const double swing = std::sqrt(hip.inertia * hip.angle / hip.torque);
    const double kept = -std::expm1(-true_frequency(setup) * swing);
    bound += hip.torque / (truth.mass * truth.gravity) * kept * kept;
  }
  return bound;
}

StandingResult run_standing(const StandingSetup& setup) {
  constexpr int half_grid = 10;
  const double tick = paper_parameters().tick;
  const double omega = true_frequency(setup);
  const double bound = standing_bound(setup);
  StandingResult result;
  result.setup = setup;
  for (int i = -half_grid; i <= half_grid; ++i) {
    for (int j = -half_grid; j <= half_grid; ++j) {
      StandingState state;
      state.position = 0.02 * i;
      state.velocity = 0.1 * j;
      state.capturable = std::abs(state.position + state.velocity / omega) <= bound;
      result.states.push_back(state);
    }
  }

  struct Outcome {
    bool recovered = false;
    double angle = 0.0;
  };
  const auto outcomes = parallel_map(result.states, [&](const StandingState& state) {
    ClosedLoop loop = on_one_foot(state.position, state.velocity, setup);
    Outcome outcome;
    while (loop.time() < settle_s + stay_s) {
      loop.tick();
      outcome.angle = std::max(outcome.angle, std::abs(loop.plant().hip_angle().x()));
      if (std::abs(loop.time() - settle_s) < 0.5 * tick) {
        const engine::Measurement& truth = loop.plant().truth();
        outcome.recovered =
            std::abs(truth.com.x()) < at_rest_m && std::abs(truth.com_velocity.x()) < at_rest_ms;
      }
      if (!loop.plant().fall_reason().empty()) return Outcome{};
    }
    return outcome;
  });
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    StandingState& state = result.states[i];
    state.recovered = outcomes[i].recovered;
    result.bound += state.capturable ? 1 : 0;
    result.recovered += state.recovered ? 1 : 0;
    result.beyond += state.recovered && !state.capturable ? 1 : 0;
    if (state.recovered) result.largest_angle = std::max(result.largest_angle, outcomes[i].angle);
  }
  return result;
}

Trace standing_trace(double position, double velocity, const StandingSetup& setup) {
  ClosedLoop loop = on_one_foot(position, velocity, setup);
  Trace trace;
  while (loop.time() < settle_s) {
    loop.tick();
    trace.push_back(loop.sample());
  }
  return trace;
}

}  // namespace stagger::sim
