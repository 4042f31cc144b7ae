// The push limit of a robot: how great a change of velocity it takes, with the conditions.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "sim/experiment/trial.h"

namespace stagger::sim {

/// One push, but for how hard it is.
struct LimitCell {
  double direction_deg = 0.0;   ///< 0 forward, 90 to the left
  std::optional<double> phase;  ///< share of single support that has passed; empty: standing
  double duration_s = 0.01;
};

struct LimitsSpec {
  /// What all trials share. Its push gives link, point and profile; seed, stand, and the rest of
  /// the push are set trial by trial.
  TrialSpec trial;
  std::vector<LimitCell> cells;
  std::optional<Side> leg = Side::left;  ///< that stands at the phase; empty: either
  std::vector<double> rungs;             ///< delta-v, ascending [m/s]
  std::vector<std::uint64_t> seeds;      ///< at least one
  double recover_within_s = 4.0;         ///< from the push's end until back for good
};

/// Rungs from, from + step, ... up to `to`, rounded to 1e-9: decimal steps give decimal rungs.
std::vector<double> ladder(double from, double to, double step);

struct Limit {
  LimitCell cell;
  /// The rung below `fail_dv`, all rungs tried if none failed; nothing when the first one did. All
  /// seeds pass at this rung and at every one below [m/s].
  std::optional<double> pass_dv;
  /// Lowest rung at which a seed does not pass; nothing when all do at all rungs [m/s].
  std::optional<double> fail_dv;
  std::optional<std::uint64_t> fail_seed;  ///< the first in the list that does not pass there
  std::string fail_reason;
  /// Up to pass_dv no trial depended on the seed: two seeds moved alike to the bit, and stand for
  /// all of them.
  bool seeds_alike = true;
  std::optional<double> ceiling_dv;  ///< of trial_ceiling() [m/s]
};

struct LimitsProgress {
  double rung = 0.0;           ///< being tried [m/s]
  std::size_t open_cells = 0;  ///< in which no seed has failed yet
  std::size_t trials = 0;      ///< that were run so far
  /// Trials still to come if no more cells fail, and if seeds that moved alike go on doing so.
  std::size_t left = 0;
};

/// How a search is run; none of it changes what is found.
struct LimitsRun {
  unsigned threads = std::thread::hardware_concurrency();
  /// Called after each trial, from any of the threads but never by two at a time. False: stop.
  std::function<bool(const LimitsProgress&)> watch;
  /// In place of run_trial() when not empty; called by many threads at a time.
  std::function<TrialResult(const TrialSpec&)> trial;
};

/// The watcher wanted no more.
class LimitsStopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The trial of one rung.
TrialSpec trial_of(const LimitsSpec& spec, const LimitCell& cell, double delta_v,
                   std::uint64_t seed, const Robot& robot);

/// A trial passes when the robot did not fall, was back within the time allowed, and was still up
/// at the end of the observation. Why it did not; empty: it passed.
std::string failure_of(const TrialResult& result, double recover_within_s);

/// One limit for each cell, in their order; the same whatever the number of threads. All cells go
/// up the rungs together; a cell ends at the first rung with a seed that fails. The seeds after
/// that one, and the rungs above, count for nothing. Throws LimitsStopped.
std::vector<Limit> find_limits(const LimitsSpec& spec, const std::shared_ptr<const Robot>& robot,
                               const LimitsRun& run = {});

}  // namespace stagger::sim
