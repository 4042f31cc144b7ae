// A campaign on a cluster: for each round an array of jobs, a shard each, and a job after it that
// merges them and submits the next round.
#pragma once

#include <string>
#include <vector>

#include "server/campaign/shards.h"

namespace stagger::server::campaign {

struct SlurmRound {
  std::uint64_t round = 0;
  std::uint64_t shards = 0;
  std::uint64_t trials = 0;  ///< that were pending when it was submitted
  std::string array;         ///< id of the array job
  std::string merge;         ///< id of the job that waits for it
};

/// Kept in the campaign's folder as slurm.json.
struct SlurmPlan {
  std::string program;  ///< this program, where the nodes find it too
  std::string robots;   ///< folder of the robots, likewise
  std::uint64_t shards = 4;
  unsigned threads = 1;                  ///< of a shard; as many cores are asked for
  std::vector<std::string> sbatch = {};  ///< arguments of the user's own, "--partition=long"
  std::vector<SlurmRound> rounds = {};
};

bool has_slurm_plan(const Folder& folder);
/// Throws std::runtime_error.
SlurmPlan read_slurm_plan(const Folder& folder);
void write_slurm_plan(const Folder& folder, const SlurmPlan& plan);

/// Submits what is pending as the next round; false when nothing is. Throws std::runtime_error with
/// what sbatch says.
bool submit_round(const Folder& folder, const Plan& plan, const Store& store, SlurmPlan& slurm);

/// "2 running, 1 pending"; empty when Slurm knows no job of that id (any more).
std::string job_states(const std::string& id);

/// Of this process, for shard_file(): the job and how often it has been started again.
std::string slurm_attempt();

}  // namespace stagger::server::campaign
