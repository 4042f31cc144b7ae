// Runs trials on all cores and stores what comes out.
#pragma once

#include <functional>
#include <optional>
#include <thread>

#include "server/campaign/design.h"
#include "server/campaign/plan.h"
#include "server/campaign/store.h"

namespace stagger::server::campaign {

/// How trials are run; none of it changes what comes out.
struct RunnerOptions {
  unsigned threads = std::thread::hardware_concurrency();
  /// Called before each trial, by many threads at a time. True: start no more.
  std::function<bool()> stop;
  /// Called after each trial has been stored, never by two threads at a time.
  std::function<void(const Record&)> stored;
  /// In place of sim::run_trial() when not empty; called by many threads at a time.
  std::function<sim::TrialResult(const sim::TrialSpec&)> trial;
};

/// Runs one trial, twice when it is to be.
Record run_planned(const PlannedTrial& trial, const std::optional<double>& recover_within_s,
                   const RunnerOptions& options = {});

/// Runs the trials of a round that the store does not hold, and is back when all are stored or when
/// it was told to stop: then those under way have been finished and stored. Stops by itself when a
/// trial that was run twice gave two results.
void run_round(const Plan& plan, const Round& round, Store& store, const RunnerOptions& options);

}  // namespace stagger::server::campaign
