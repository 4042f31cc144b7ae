#include "sim/experiment/limits.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <sstream>

#include "sim/experiment/parallel.h"
#include "sim/experiment/trial_ceiling.h"

namespace stagger::sim {
namespace {

/// Trials that move alike with this many seeds are taken to move alike with all.
constexpr std::size_t probe_seeds = 2;

/// Counts trials and tells the watcher.
class Progress {
 public:
  explicit Progress(const LimitsRun& run) : run_(run) {}

  void begin(double rung, std::size_t open_cells, std::size_t left) {
    now_.rung = rung;
    now_.open_cells = open_cells;
    now_.left = left;
  }

  /// One trial is over, or turned out not to be needed.
  void count(bool was_run) {
    const std::lock_guard lock(mutex_);
    --now_.left;
    if (!was_run) return;
    ++now_.trials;
    if (run_.watch && !run_.watch(now_)) throw LimitsStopped("stopped");
  }

 private:
  const LimitsRun& run_;
  std::mutex mutex_;
  LimitsProgress now_;
};

/// All cells on their way up the ladder.
class Search {
 public:
  Search(const LimitsSpec& spec, const std::shared_ptr<const Robot>& robot, const LimitsRun& run)
      : spec_(spec), robot_(robot), run_(run), progress_(run) {
    for (const LimitCell& cell : spec.cells) {
      Limit limit;
      limit.cell = cell;
      limit.ceiling_dv =
          trial_ceiling(trial_of(spec, cell, 1.0, spec.seeds.front(), *robot), *robot);
      limits_.push_back(std::move(limit));
    }
  }

  std::vector<Limit> climb() {
    for (rung_ = 0; rung_ < spec_.rungs.size(); ++rung_) {
      const std::vector<std::size_t> open = open_cells();
      const auto hashes = try_seeds(open, 0, probe_);
      std::vector<std::size_t> unlike;
      for (std::size_t i = 0; i < open.size(); ++i) {
        Limit& limit = limits_[open[i]];
        if (limit.fail_dv || hashes[i * probe_] == hashes[(i + 1) * probe_ - 1]) continue;
        limit.seeds_alike = false;
        unlike.push_back(open[i]);
      }
      try_seeds(unlike, probe_, spec_.seeds.size());
      for (const std::size_t cell : open_cells()) limits_[cell].pass_dv = spec_.rungs[rung_];
    }
    return std::move(limits_);
  }

 private:
  std::vector<std::size_t> open_cells() const {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < limits_.size(); ++i) {
      if (!limits_[i].fail_dv) open.push_back(i);
    }
    return open;
  }

  /// Trials that come after those of seeds `first` on at this rung.
  std::size_t left_after(std::size_t first) const {
    const std::size_t all = spec_.seeds.size();
    const bool rest_to_come = first == 0;
    std::size_t left = 0;
    for (const std::size_t cell : open_cells()) {
      // Nothing is known yet of seeds that were never tried.
      const bool alike = limits_[cell].seeds_alike && limits_[cell].pass_dv;
      const std::size_t each = alike ? probe_ : all;
      left += (spec_.rungs.size() - rung_ - 1) * each + (rest_to_come ? each - probe_ : 0);
    }
    return left;
  }

  /// Tries these cells with the seeds [first, last) at the present rung and notes what fails.
  /// Returns the hashes of the trials, the seeds of a cell side by side; 0 for those not needed.
  std::vector<std::uint64_t> try_seeds(const std::vector<std::size_t>& cells, std::size_t first,
                                       std::size_t last) {
    struct Job {
      std::size_t cell;
      std::size_t seed;
    };
    struct Outcome {
      std::string failure;
      std::uint64_t hash = 0;
    };
    std::vector<Job> jobs;
    for (const std::size_t cell : cells) {
      for (std::size_t seed = first; seed < last; ++seed) jobs.push_back({cell, seed});
    }
    progress_.begin(spec_.rungs[rung_], open_cells().size(), jobs.size() + left_after(first));

    // The first seed that fails decides: those after it need not be tried, those before it must be.
    std::vector<std::atomic<std::size_t>> first_failed(limits_.size());
    for (auto& seed : first_failed) seed = std::numeric_limits<std::size_t>::max();
    const auto try_one = [&](const Job& job) {
      Outcome outcome;
      std::atomic<std::size_t>& lowest = first_failed[job.cell];
      if (lowest < job.seed) {
        progress_.count(false);
        return outcome;
      }
      const TrialSpec trial = trial_of(spec_, spec_.cells[job.cell], spec_.rungs[rung_],
                                       spec_.seeds[job.seed], *robot_);
      const TrialResult result = run_.trial ? run_.trial(trial) : run_trial(trial, robot_);
      outcome.failure = failure_of(result, spec_.recover_within_s);
      outcome.hash = result.state_hash;
      std::size_t present = lowest;
      while (!outcome.failure.empty() && job.seed < present) {
        if (lowest.compare_exchange_weak(present, job.seed)) break;
      }
      progress_.count(true);
      return outcome;
    };
    const auto outcomes = parallel_map(jobs, try_one, run_.threads);

    std::vector<std::uint64_t> hashes;
    hashes.reserve(jobs.size());
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      hashes.push_back(outcomes[i].hash);
      Limit& limit = limits_[jobs[i].cell];
      if (limit.fail_dv || outcomes[i].failure.empty()) continue;
      limit.fail_dv = spec_.rungs[rung_];
      limit.fail_seed = spec_.seeds[jobs[i].seed];
      limit.fail_reason = outcomes[i].failure;
    }
    return hashes;
  }

  const LimitsSpec& spec_;
  const std::shared_ptr<const Robot>& robot_;
  const LimitsRun& run_;
  Progress progress_;
  std::size_t probe_ = std::min(probe_seeds, spec_.seeds.size());
  std::vector<Limit> limits_;
  std::size_t rung_ = 0;
};

}  // namespace

std::vector<double> ladder(double from, double to, double step) {
  constexpr double digits = 1e9;
  std::vector<double> rungs;
  for (int i = 0;; ++i) {
    const double rung = std::round((from + i * step) * digits) / digits;
    if (!(rung <= to + 0.5 / digits)) return rungs;
    rungs.push_back(rung);
  }
}

TrialSpec trial_of(const LimitsSpec& spec, const LimitCell& cell, double delta_v,
                   std::uint64_t seed, const Robot& robot) {
  TrialSpec trial = spec.trial;
  trial.seed = seed;
  trial.stand = !cell.phase;
  if (trial.stand) trial.walk = {};
  PushSpec push = spec.trial.push.value_or(PushSpec{});
  push.direction = horizontal_direction(cell.direction_deg);
  push.duration_s = cell.duration_s;
  push.impulse_ns = delta_v * robot.model.mass();
  push.trigger = Immediate{};
  if (cell.phase) push.trigger = PhaseTrigger{WalkingState::single_support, spec.leg, *cell.phase};
  trial.push = push;
  return trial;
}

std::string failure_of(const TrialResult& result, double recover_within_s) {
  switch (result.outcome) {
    case TrialOutcome::fell:
      return "fell: " + result.reason;
    case TrialOutcome::timeout:
    case TrialOutcome::invalid:
      return result.reason;
    case TrialOutcome::recovered:
      break;
  }
  if (result.recovery_time_s && *result.recovery_time_s <= recover_within_s) return {};
  std::ostringstream text;
  text << "not back within " << recover_within_s << " s";
  return text.str();
}

std::vector<Limit> find_limits(const LimitsSpec& spec, const std::shared_ptr<const Robot>& robot,
                               const LimitsRun& run) {
  return Search(spec, robot, run).climb();
}

}  // namespace stagger::sim
