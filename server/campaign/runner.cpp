#include "server/campaign/runner.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <mutex>
#include <vector>

#include "sim/experiment/parallel.h"
#include "sim/experiment/trial_ceiling.h"

namespace stagger::server::campaign {
namespace {

/// Of the calling thread [s].
double cpu_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

Record run_planned(const PlannedTrial& trial, const std::optional<double>& recover_within_s,
                   const RunnerOptions& options) {
  Record record;
  record.number = trial.number;
  record.id = trial.id;
  record.seed = trial.spec.seed;
  record.repeat = trial.repeat;
  record.values = to_text(trial.values);
  record.push = trial.push;
  if (!trial.refused.empty()) {
    record.result.reason = "cannot be run: " + trial.refused;
    return record;
  }
  const auto run = [&] {
    return options.trial ? options.trial(trial.spec) : sim::run_trial(trial.spec, trial.robot);
  };
  const double start = cpu_time();
  record.result = run();
  record.cpu_s = cpu_time() - start;
  record.ceiling_dv = sim::trial_ceiling(trial.spec, *trial.robot);
  record.passed = record.result.outcome == sim::TrialOutcome::recovered;
  if (recover_within_s) {
    const auto& time = record.result.recovery_time_s;
    record.passed = record.passed && time && *time <= *recover_within_s;
  }
  if (trial.twice) record.repeated = same_result(record.result, run());
  return record;
}

void run_round(const Plan& plan, const Round& round, Store& store, const RunnerOptions& options) {
  std::atomic<std::uint64_t> next{0};
  std::atomic<bool> ended{false};
  std::mutex telling;
  const auto run_next = [&] {
    const std::uint64_t at = next++;
    if (at >= round.size()) return false;
    if (store.verdict(round[at])) return true;
    const Record record = run_planned(plan.trial(round[at]), plan.spec().recover_within_s, options);
    store.put(record);
    const std::lock_guard lock(telling);
    if (options.stored) options.stored(record);
    return record.repeated != false;
  };
  const auto work = [&](unsigned /*worker*/) {
    try {
      while (!ended && !(options.stop && options.stop()) && run_next()) {
      }
      if (next < round.size()) ended = true;
    } catch (...) {
      ended = true;  // of the others too: what was thrown ends the round
      throw;
    }
    return 0;
  };
  const std::vector<unsigned> workers(std::max(options.threads, 1U));
  sim::parallel_map(workers, work, options.threads);
}

}  // namespace stagger::server::campaign
