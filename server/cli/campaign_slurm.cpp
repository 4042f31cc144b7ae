#include <algorithm>
#include <iostream>

#include "server/campaign/check_thresholds.h"
#include "server/campaign/slurm.h"
#include "server/cli/campaign.h"
#include "server/cli/cli.h"
#include "server/cli/input.h"
#include "server/cli/interrupt.h"

namespace stagger::server {
namespace {

using campaign::Folder;
using campaign::Plan;
using campaign::SlurmPlan;
using campaign::Store;

void tell_round(const Folder& folder, const campaign::SlurmRound& round, bool json) {
  if (json) {
    std::cout << to_text({{"event", "submitted"},
                          {"folder", folder.path().string()},
                          {"round", round.round},
                          {"shards", round.shards},
                          {"trials", round.trials},
                          {"array", round.array},
                          {"merge", round.merge}})
              << '\n';
    return;
  }
  std::cout << folder.path().string() << ": round " << round.round << ", " << round.trials
            << " trials in " << round.shards << " shards, job " << round.array << ", then job "
            << round.merge << '\n';
}

/// Has a threshold failed that ends the campaign?
bool is_aborted(const Plan& plan, const Store& store) {
  const auto results = check_thresholds(plan, store, {});
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (plan.spec().thresholds[i].abort && results[i].value && !results[i].passed) return true;
  }
  return false;
}

}  // namespace

int submit_campaign(const CampaignOptions& options, const Folders& folders, RobotLibrary& library) {
  if (!options.slurm) {
    std::cerr << "stagger: campaign submit: say where to, with --slurm\n";
    return exit_usage;
  }
  const std::string text = read_input(options.spec);
  const auto plan = load_plan(options.spec == "-" ? "standard input" : options.spec, text, library);
  if (plan == nullptr) return exit_usage;
  const Folder folder(options.out.empty() ? plan->spec().name + ".campaign" : options.out);
  folder.create(text, Store::Journal::rollback);
  const Store store(folder.store(), Store::Access::read);
  SlurmPlan slurm{folders.executable.string(), std::filesystem::absolute(folders.robots).string(),
                  options.shards, std::max(options.threads, 1U), options.sbatch};
  submit_round(folder, *plan, store, slurm);
  tell_round(folder, slurm.rounds.back(), options.json);
  return exit_ok;
}

int shard_campaign(const CampaignOptions& options, RobotLibrary& library) {
  const Folder folder(options.folder);
  const Store whole(folder.store(), Store::Access::read);
  const auto plan = load_plan(options.folder, whole.specification(), library);
  if (plan == nullptr) return exit_usage;
  listen_for_interrupts();
  campaign::RunnerOptions runner;
  runner.threads = std::max(options.threads, 1U);
  runner.stop = [] { return interrupted(); };
  const std::uint64_t left =
      run_shard(folder, *plan, {options.round, options.index, options.shards},
                campaign::slurm_attempt(), runner);
  if (left == 0) return exit_ok;
  std::cerr << "stagger: " << left << " trials of this shard are left to run\n";
  return exit_interrupted;
}

int merge_campaign(const CampaignOptions& options, RobotLibrary& library) {
  const Folder folder(options.folder);
  const campaign::FolderLock lock(folder);
  Store store(folder.store(), Store::Access::write);
  const auto plan = load_plan(options.folder, store.specification(), library);
  if (plan == nullptr) return exit_usage;
  const campaign::Merged merged = merge_shards(folder, store);
  for (const auto& file : merged.unreadable) {
    std::cerr << "stagger: " << file.string() << ": cannot be read; its trials are run again\n";
  }
  const bool ended = store.counts().mismatches > 0 || is_aborted(*plan, store);
  // By hand, without a round, it only merges.
  if (options.round > 0 && !ended && campaign::pending_trials(*plan, store).size() > 0) {
    SlurmPlan slurm = campaign::read_slurm_plan(folder);
    if (slurm.rounds.back().round > options.round) return exit_ok;  // was done before
    if (merged.fresh == 0) {
      throw std::runtime_error(options.folder + ": round " + std::to_string(options.round) +
                               " brought no trial; its logs are in " +
                               (folder.path() / "shards").string());
    }
    submit_round(folder, *plan, store, slurm);
    tell_round(folder, slurm.rounds.back(), options.json);
    return exit_ok;
  }
  return conclude(folder, *plan, store, campaign::End::complete, options);
}

void tell_slurm(const Folder& folder, const Store& store) {
  if (!campaign::has_slurm_plan(folder)) return;
  const SlurmPlan slurm = campaign::read_slurm_plan(folder);
  const campaign::SlurmRound& round = slurm.rounds.back();
  const std::string shards = campaign::job_states(round.array);
  const std::string merge = campaign::job_states(round.merge);
  std::cout << "slurm: round " << round.round << ", job " << round.array << ": "
            << (shards.empty() ? "ended" : shards) << "; merge, job " << round.merge << ": "
            << (merge.empty() ? "ended" : merge) << "; "
            << campaign::trials_under_way(folder, store) << " of " << round.trials
            << " trials run and not merged yet\n";
}

}  // namespace stagger::server
