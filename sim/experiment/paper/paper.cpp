#include "sim/experiment/paper/paper.h"

#include <numbers>

namespace stagger::sim {
namespace {

StandingExample example(double position, double velocity) {
  return {position, velocity, standing_trace(position, velocity)};
}

StandingFigures run_scenario1(int noise_seeds) {
  StandingFigures figures;
  figures.ankle = run_standing();
  figures.noise_seeds = noise_seeds;
  for (int seed = 1; seed <= noise_seeds; ++seed) {
    StandingResult result = run_standing(
        {.hip = {}, .noise = paper_noise, .seed = static_cast<std::uint64_t>(seed), .error = {}});
    figures.noise_beyond += result.beyond;
    if (seed == 1 || result.recovered < figures.ankle_noise.recovered) {
      figures.ankle_noise = std::move(result);
    }
  }
  for (const engine::HipParameters& hip : standing_hips()) {
    figures.hips.push_back(run_standing({.hip = hip, .noise = 0.0, .seed = 1, .error = {}}));
  }
  // Neighbours on the grid on either side of the bound.
  figures.recovered = example(-0.10, 0.5);
  figures.lost = example(-0.10, 0.6);
  return figures;
}

SteppingFigures run_scenario2(const PaperRequest& request) {
  SteppingFigures figures;
  if (request.timing) {
    figures.limits = stepping_limits({{*request.timing, request.direction}}, request.seeds);
    return figures;
  }
  std::vector<std::pair<PushTiming, double>> forward;
  std::vector<std::pair<PushTiming, double>> around;
  for (const PushTiming& timing : stepping_timings()) {
    forward.emplace_back(timing, 0.0);
    for (const int eighth : {1, 2, 3, 4, -3, -2, -1}) {
      around.emplace_back(timing, 0.25 * std::numbers::pi * eighth);
    }
  }
  figures.limits = stepping_limits(forward, request.seeds);
  figures.directions = stepping_limits(around, 0);
  figures.paper_fit = run_paper_fit();
  figures.pushes = run_published_pushes(SteppingProfile::stagger, true);
  figures.fit_pushes = run_published_pushes(SteppingProfile::paper_fit, true);
  return figures;
}

}  // namespace

std::vector<engine::HipParameters> standing_hips() {
  const auto hip = [](double torque, double inertia, double angle) {
    engine::HipParameters parameters;
    parameters.torque = torque;
    parameters.inertia = inertia;
    parameters.angle = angle;
    return parameters;
  };
  return {hip(20.0, 0.8, 0.3), hip(40.0, 0.8, 0.5), hip(60.0, 1.0, 0.5), hip(100.0, 1.0, 0.5),
          hip(100.0, 2.0, 1.0)};
}

PaperResults run_paper(const PaperRequest& request) {
  PaperResults results;
  if (request.plan) results.plan = run_plan();
  if (request.tracking) results.tracking = run_tracking(request.seeds);
  if (request.standing) results.standing = run_scenario1(request.standing_seeds);
  if (request.stepping) results.stepping = run_scenario2(request);
  if (request.robustness) results.robustness = run_robustness();
  return results;
}

}  // namespace stagger::sim
