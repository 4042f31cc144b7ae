#include "server/campaign/campaign.h"

#include <algorithm>
#include <atomic>
#include <set>

#include "server/campaign/check_thresholds.h"

namespace stagger::server::campaign {
namespace {

/// When to look at the thresholds again: each time the trials are a quarter more, so that looking
/// costs a share of the work, however long the campaign.
class AbortCheck {
 public:
  explicit AbortCheck(const Plan& plan) : plan_(plan) {
    const auto& thresholds = plan.spec().thresholds;
    wanted_ = std::any_of(thresholds.begin(), thresholds.end(),
                          [](const Threshold& threshold) { return threshold.abort; });
  }

  bool failed(const Store& store) {
    constexpr std::uint64_t fewest = 20;
    const std::uint64_t count = wanted_ ? store.count() : 0;
    if (!wanted_ || count < next_) return false;
    next_ = std::max(fewest, count + count / 4);
    const auto& thresholds = plan_.spec().thresholds;
    const auto results = check_thresholds(plan_, store, {});
    for (std::size_t i = 0; i < results.size(); ++i) {
      // What no trial has been seen of has not failed yet.
      if (thresholds[i].abort && results[i].value && !results[i].passed) return true;
    }
    return false;
  }

 private:
  const Plan& plan_;
  bool wanted_ = false;
  std::uint64_t next_ = 20;
};

}  // namespace

End run_campaign(const Plan& plan, Store& store, const CampaignOptions& options) {
  std::atomic<bool> aborted{false};
  std::atomic<bool> mismatch{store.counts().mismatches > 0};
  AbortCheck abort_check(plan);
  Progress progress;
  progress.most = plan.design().most_trials();

  RunnerOptions runner = options.runner;
  const auto told_to_stop = [&] { return options.runner.stop && options.runner.stop(); };
  runner.stop = [&] { return aborted || told_to_stop(); };
  runner.stored = [&](const Record& record) {
    if (record.repeated == false) mismatch = true;
    progress.counts = store.counts();
    if (options.runner.stored) options.runner.stored(record);
    if (options.watch) options.watch(record, progress);
    if (!aborted && abort_check.failed(store)) aborted = true;
  };
  for (;;) {
    if (mismatch) return End::mismatch;
    if (aborted) return End::aborted;
    const Round round = plan.design().next_round(store);
    if (round.empty()) return End::complete;
    if (told_to_stop()) return End::stopped;
    ++progress.round;
    run_round(plan, round, store, runner);
  }
}

std::vector<std::uint64_t> changed_trials(const Plan& plan, const Store& store) {
  std::vector<std::uint64_t> changed;
  std::set<std::string> seen;
  store.for_each([&](const Record& record) {
    const PlannedTrial trial = plan.trial(record.number);
    if (!trial.refused.empty() || !seen.insert(trial.spec.robot).second) return;
    if (hash_of(run_planned(trial, plan.spec().recover_within_s)) != hash_of(record)) {
      changed.push_back(record.number);
    }
  });
  return changed;
}

void require_unchanged(const Plan& plan, const Store& store) {
  if (store.version() != STAGGER_VERSION) {
    throw std::runtime_error("begun by version " + store.version() + "; this is " STAGGER_VERSION);
  }
  const auto changed = changed_trials(plan, store);
  if (changed.empty()) return;
  throw std::runtime_error("trial " + std::to_string(changed.front()) +
                           " gives another result now than is stored: the program or a robot has "
                           "changed; run the campaign anew");
}

}  // namespace stagger::server::campaign
