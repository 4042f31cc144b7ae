// The paper's scenarios with an engine that is wrong about its robot.
#pragma once

#include "sim/experiment/paper/stepping.h"

namespace stagger::sim {

struct RobustnessResult {
  ModelError error;
  /// Scenario 1 without noise: states that the ankle brings to rest, of those that the true robot
  /// could be.
  int standing_recovered = 0;
  int standing_bound = 0;
  /// Scenario 2 without noise, one for each of stepping_timings().
  std::vector<StrategyForces> fall;
  /// Runs without a push, in each timing with each strategy, with the paper's noise and without, in
  /// which the robot fell: must be 0.
  int unpushed_falls = 0;
  int unpushed_runs = 0;
};

/// 10 % errors of mass and CoM height both ways, 20 ms of delay, and all at once. The first entry
/// is the one without an error, to measure the loss against.
std::vector<RobustnessResult> run_robustness();

}  // namespace stagger::sim
