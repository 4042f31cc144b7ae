// Scenario 1 of the paper: standing on one foot, 441 initial states of the CoM in the sagittal
// plane, and which of them the ankle (and the hip) bring to rest within two seconds.
#pragma once

#include "sim/experiment/paper/closed_loop.h"

namespace stagger::sim {

struct StandingState {
  double position = 0.0;    ///< CoM from the middle of the foot [m]
  double velocity = 0.0;    ///< [m/s]
  bool capturable = false;  ///< within the bound of what any controller can do
  bool recovered = false;   ///< |c| < 1 cm and |v| < 3 cm/s after 2 s, and not fallen 3 s later
};

struct StandingSetup {
  engine::HipParameters hip;  ///< no torque: ankle alone
  double noise = 0.0;         ///< standard deviation of the measured CoM and DCM [m]
  std::uint64_t seed = 1;     ///< of the noise
  ModelError error;
};

struct StandingResult {
  StandingSetup setup;
  int bound = 0;               ///< states that are capturable
  int recovered = 0;           ///< and those that were brought to rest
  int beyond = 0;              ///< recovered although the bound says that nobody can: must be 0
  double largest_angle = 0.0;  ///< lean of the flywheel in the recovered ones [rad]
  std::vector<StandingState> states;
};

/// |c + v/w| <= half foot + d with d = tau/(m g) (1 - e^{-w T1})^2, T1 = sqrt(J theta/tau): the
/// ZMP at the edge, and the flywheel thrown to its limit and stopped there. Of the true robot [m].
double standing_bound(const StandingSetup& setup);

/// The grid of the paper: position -0.2..0.2 m by 0.02, velocity -1..1 m/s by 0.1.
StandingResult run_standing(const StandingSetup& setup = {});

/// One of them as a trace of 2 s, for the paper's examples.
Trace standing_trace(double position, double velocity, const StandingSetup& setup = {});

}  // namespace stagger::sim
