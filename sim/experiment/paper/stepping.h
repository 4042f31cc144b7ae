// Scenario 2 of the paper: stepping in place, a push of 10 ms, and the greatest force that each
// strategy survives.
#pragma once

#include <optional>

#include "sim/experiment/paper/closed_loop.h"

namespace stagger::sim {

/// Gait and the moment of the push: what a push limit depends on most.
struct PushTiming {
  double t_ss = 0.8;    ///< [s]
  double t_ds = 0.2;    ///< [s]
  double t_left = 0.6;  ///< of the (left foot's) single support when the push begins [s]
};

/// What a strategy of the paper may use: ankle alone, and the next step's place, and its time.
enum class SteppingStrategy : std::uint8_t { ankle, location, time };
inline constexpr std::array stepping_strategies{SteppingStrategy::ankle, SteppingStrategy::location,
                                                SteppingStrategy::time};
engine::Strategies strategies_of(SteppingStrategy strategy);

struct SteppingSetup {
  engine::Parameters parameters;
  LipmParameters truth;
  double t_left = 0.6;     ///< of single support when the push begins [s]
  double direction = 0.0;  ///< of the push, 0 forward, to the left positive [rad]
};

/// Our own settings, within the limits that the paper states.
SteppingSetup stepping_setup(const PushTiming& timing, SteppingStrategy strategy,
                             double noise = 0.0, std::uint64_t seed = 1,
                             const ModelError& error = {});

inline constexpr double push_duration = 0.01;  ///< [s]

struct SteppingOutcome {
  bool fell = false;
  double push_time = 0.0;  ///< when the push began [s]
  /// The step under way at the push: where it landed from the stance foot, forward [m], and by how
  /// much its single support was changed [s].
  double landing = 0.0;
  double time_change = 0.0;
};

/// Watches for `watch_s` after the push; what happens goes into `trace` if there is one.
SteppingOutcome run_stepping(const SteppingSetup& setup, double force, Trace* trace = nullptr);

/// Force that no controller survives [N]; see push_ceiling.h.
double stepping_ceiling(const SteppingSetup& setup, SteppingStrategy strategy);

/// Lowest force at which the robot falls [N], found on a ladder of `rungs` up to 5 % above the
/// ceiling (so that a fall below a force that is survived is seen) and then closer between two.
double first_fall(const SteppingSetup& setup, double ceiling, int rungs = 42);

struct StrategyForces {
  double ankle = 0.0;     ///< [N]
  double location = 0.0;  ///< [N]
  double time = 0.0;      ///< [N]
};

double& force_of(StrategyForces& forces, SteppingStrategy strategy);

struct SteppingLimits {
  PushTiming timing;
  double direction = 0.0;  ///< [rad]
  StrategyForces fall;     ///< first fall, without noise
  StrategyForces ceiling;
  StrategyForces noise_median;  ///< first fall under the paper's noise, median of the seeds
  StrategyForces noise_least;   ///< and the least and the greatest of them
  StrategyForces noise_greatest;
  int noise_seeds = 0;
};

/// Runs the searches of all conditions side by side. No noise is tried with noise_seeds = 0.
std::vector<SteppingLimits> stepping_limits(
    const std::vector<std::pair<PushTiming, double>>& conditions, int noise_seeds);

/// Five moments from an easy one to a hard one: what is left of single support decides the most.
std::vector<PushTiming> stepping_timings();

}  // namespace stagger::sim
