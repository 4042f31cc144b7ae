// Runs a campaign round by round until its design wants no more.
#pragma once

#include <functional>

#include "server/campaign/runner.h"

namespace stagger::server::campaign {

/// How far a campaign is.
struct Progress {
  Counts counts;
  std::uint64_t most = 0;   ///< trials at the most
  std::uint64_t round = 0;  ///< 1, 2, ...
};

struct CampaignOptions {
  RunnerOptions runner;
  /// Called after each trial, never by two threads at a time.
  std::function<void(const Record&, const Progress&)> watch;
};

enum class End : std::uint8_t {
  complete,
  stopped,  ///< the runner was told to
  aborted,  ///< a threshold with `abort` failed
  mismatch  ///< a trial did not repeat to the bit
};

/// Goes on from what the store holds.
End run_campaign(const Plan& plan, Store& store, const CampaignOptions& options = {});

/// Runs the first trial that the store holds of each robot again: has the program, or a robot,
/// changed since? Returns the numbers of those with another result.
std::vector<std::uint64_t> changed_trials(const Plan& plan, const Store& store);
/// Throws std::runtime_error when what the store holds and what would be added do not go together:
/// another version began it, or changed_trials() finds one.
void require_unchanged(const Plan& plan, const Store& store);

}  // namespace stagger::server::campaign
