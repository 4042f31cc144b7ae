#include "sim/experiment/paper/standing.h"

#include <cmath>

#include "sim/experiment/parallel.h"

namespace stagger::sim {
namespace {

constexpr double settle_s = 2.0;
constexpr double stay_s = 3.0;
constexpr double at_rest_m = 0.01;
constexpr double at_rest_ms = 0.03;

ClosedLoop on_one_foot(double position, double velocity, const engine::HipParameters& hip,
                       double noise, std::uint64_t seed) {
  engine::Parameters parameters = paper_parameters(noise);
  parameters.hip = hip;
  parameters.strategies.hip = hip.torque > 0.0;
  LipmParameters truth = paper_plant(noise, seed);
  truth.hip = hip;
  // Both feet in one place are one foot: idle, the engine stands on it.
  truth.stance_width = 0.0;
  return ClosedLoop(parameters, truth, Vec2(position, 0.0), Vec2(velocity, 0.0));
}

}  // namespace

double standing_bound(const engine::Parameters& p, const engine::HipParameters& hip) {
  double bound = p.foot_half_length;
  if (hip.torque > 0.0) {
    const double swing = std::sqrt(hip.inertia * hip.angle / hip.torque);
    const double kept = -std::expm1(-engine::natural_frequency(p) * swing);
    bound += hip.torque / (p.mass * p.gravity) * kept * kept;
  }
  return bound;
}

StandingResult run_standing(const engine::HipParameters& hip, double noise, std::uint64_t seed) {
  constexpr int half_grid = 10;
  const engine::Parameters parameters = paper_parameters(noise);
  const double omega = engine::natural_frequency(parameters);
  const double bound = standing_bound(parameters, hip);
  StandingResult result;
  result.hip = hip;
  result.noise = noise;
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
    ClosedLoop loop = on_one_foot(state.position, state.velocity, hip, noise, seed);
    Outcome outcome;
    while (loop.time() < settle_s + stay_s) {
      loop.tick();
      outcome.angle = std::max(outcome.angle, std::abs(loop.plant().hip_angle().x()));
      if (std::abs(loop.time() - settle_s) < 0.5 * parameters.tick) {
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

Trace standing_trace(double position, double velocity, const engine::HipParameters& hip) {
  ClosedLoop loop = on_one_foot(position, velocity, hip, 0.0, 1);
  Trace trace;
  while (loop.time() < settle_s) {
    loop.tick();
    trace.push_back(loop.sample());
  }
  return trace;
}

}  // namespace stagger::sim
