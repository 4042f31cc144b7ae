// A campaign in parts: many processes run the trials of a round, each into a file of its own, and
// one takes them all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/campaign/folder.h"
#include "server/campaign/runner.h"

namespace stagger::server::campaign {

/// One part of a round.
struct Shard {
  std::uint64_t round = 0;  ///< 1, 2, ...
  std::uint64_t index = 0;  ///< below `count`
  std::uint64_t count = 1;
};

/// Trials that the design wants next and the store does not hold. It is the same for every shard of
/// a round: nobody writes to the campaign's store while they run.
Round pending_trials(const Plan& plan, const Store& store);

/// A file that no other process writes to: each attempt at a shard has its own ("17-0"), so that
/// one that is started again never meets its forerunner, dead or not.
std::filesystem::path shard_file(const Folder& folder, const Shard& shard,
                                 const std::string& attempt);
/// Files of all rounds, sorted.
std::vector<std::filesystem::path> shard_files(const Folder& folder);

/// Runs the shard's trials that no earlier attempt has stored. Returns how many are left: 0 unless
/// it was told to stop.
std::uint64_t run_shard(const Folder& folder, const Plan& plan, const Shard& shard,
                        const std::string& attempt, const RunnerOptions& options);

struct Merged {
  std::uint64_t fresh = 0;  ///< trials that the store did not hold
  std::vector<std::filesystem::path> unreadable;
};
/// Takes what the files of all rounds hold into the campaign's store, none twice. Throws
/// std::runtime_error when two files tell different results of one trial.
Merged merge_shards(const Folder& folder, Store& store);

/// Trials in the files of all rounds that the campaign's store does not hold yet.
std::uint64_t trials_under_way(const Folder& folder, const Store& store);

}  // namespace stagger::server::campaign
