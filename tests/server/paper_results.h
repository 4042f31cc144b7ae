// Results as run_paper() gives them, in small: some are run, those that take long are made up.
#pragma once

#include "sim/experiment/paper/paper.h"

namespace stagger::server {

inline sim::SteppingLimits made_up_limits(double direction, int noise_seeds) {
  sim::SteppingLimits limits;
  limits.timing = {0.8, 0.2, 0.6};
  limits.direction = direction;
  limits.fall = {700.0, 2100.0, 3500.0};
  limits.ceiling = {1000.0, 2800.0, 4000.0};
  limits.noise_median = {690.0, 2090.0, 3490.0};
  limits.noise_least = {600.0, 2000.0, 3400.0};
  limits.noise_greatest = {710.0, 2110.0, 3510.0};
  limits.noise_seeds = noise_seeds;
  return limits;
}

inline sim::PaperResults small_results() {
  sim::PaperResults results;
  results.plan = sim::run_plan();
  results.tracking = sim::run_tracking(1);

  sim::StandingFigures standing;
  standing.ankle.states = {
      {0.0, 0.0, true, true}, {0.1, 0.1, true, false}, {0.2, 0.2, false, false}};
  standing.ankle.bound = 2;
  standing.ankle.recovered = 1;
  standing.ankle_noise = standing.ankle;
  standing.noise_seeds = 3;
  standing.hips.assign(2, standing.ankle);
  standing.hips[1].setup.hip.torque = 40.0;
  standing.recovered.trace = standing.lost.trace = {sim::TraceSample{}};
  results.standing = standing;

  sim::SteppingFigures stepping;
  stepping.limits = {made_up_limits(0.0, 5)};
  stepping.directions = {made_up_limits(1.5707963267948966, 0)};
  stepping.paper_fit = sim::published_figures;
  for (const sim::PublishedPush& push : sim::published_pushes) {
    sim::PushComparison comparison;
    comparison.published = push;
    comparison.ours.fell = push.fell;
    comparison.trace = {sim::TraceSample{}};
    stepping.pushes.push_back(comparison);
    stepping.fit_pushes.push_back(comparison);
  }
  results.stepping = stepping;

  sim::RobustnessResult robust;
  robust.fall.assign(5, {700.0, 2100.0, 3500.0});
  results.robustness = {robust, robust};
  results.robustness[1].error.mass = 1.1;
  results.robustness[1].fall[3].location = 1050.0;
  return results;
}

}  // namespace stagger::server
