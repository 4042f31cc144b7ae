#include "server/campaign/slurm.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "server/child_process.h"
#include "server/json/json.h"
#include "server/shell_word.h"

namespace stagger::server::campaign {
namespace {

namespace fs = std::filesystem;

fs::path slurm_file(const Folder& folder) { return folder.path() / "slurm.json"; }

ChildResult slurm_command(std::vector<std::string> words) {
  const std::atomic<bool> stop{false};
  return run_child(
      {"/usr/bin/env", std::move(words), fs::current_path(), std::chrono::milliseconds(60'000)},
      stop);
}

/// Returns the new job's id.
std::string sbatch(const SlurmPlan& slurm, std::vector<std::string> options,
                   const std::string& line) {
  std::vector<std::string> words{"sbatch", "--parsable", "--requeue"};
  words.insert(words.end(), slurm.sbatch.begin(), slurm.sbatch.end());
  words.insert(words.end(), options.begin(), options.end());
  words.push_back("--wrap=" + line);
  const ChildResult result = slurm_command(std::move(words));
  // "17", or "17;cluster".
  const std::string id = result.out.substr(0, result.out.find_first_of(";\n"));
  if (result.end == ChildResult::End::exited && result.code == 0 && !id.empty()) return id;
  throw std::runtime_error("sbatch: " + (result.err.empty() ? "no answer" : result.err));
}

std::string text_of(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + shell_word(word);
  return text;
}

}  // namespace

bool has_slurm_plan(const Folder& folder) { return fs::exists(slurm_file(folder)); }

SlurmPlan read_slurm_plan(const Folder& folder) {
  std::ifstream in(slurm_file(folder));
  try {
    const Json json = Json::parse(in);
    SlurmPlan plan{json.at("program"), json.at("robots"), json.at("shards"), json.at("threads"),
                   json.at("sbatch")};
    for (const Json& round : json.at("rounds")) {
      plan.rounds.push_back({round.at("round"), round.at("shards"), round.at("trials"),
                             round.at("array"), round.at("merge")});
    }
    return plan;
  } catch (const Json::exception& error) {
    throw std::runtime_error(slurm_file(folder).string() + ": " + error.what());
  }
}

void write_slurm_plan(const Folder& folder, const SlurmPlan& plan) {
  Json json{{"program", plan.program}, {"robots", plan.robots}, {"shards", plan.shards},
            {"threads", plan.threads}, {"sbatch", plan.sbatch}, {"rounds", Json::array()}};
  for (const SlurmRound& round : plan.rounds) {
    json["rounds"].push_back({{"round", round.round},
                              {"shards", round.shards},
                              {"trials", round.trials},
                              {"array", round.array},
                              {"merge", round.merge}});
  }
  const fs::path file = slurm_file(folder);
  const fs::path unfinished = file.string() + ".part";
  {
    std::ofstream out(unfinished);
    out << json.dump(2) << '\n';
    out.close();
    if (!out) throw std::runtime_error("cannot write " + file.string());
  }
  fs::rename(unfinished, file);
}

bool submit_round(const Folder& folder, const Plan& plan, const Store& store, SlurmPlan& slurm) {
  const std::uint64_t pending = pending_trials(plan, store).size();
  if (pending == 0) return false;
  SlurmRound round;
  round.round = slurm.rounds.empty() ? 1 : slurm.rounds.back().round + 1;
  round.shards = std::min(slurm.shards, pending);
  round.trials = pending;
  const std::string number = std::to_string(round.round);
  const std::string count = std::to_string(round.shards);
  const std::string threads = std::to_string(slurm.threads);
  const std::string path = fs::absolute(folder.path()).string();
  const std::string log = path + "/shards/round-" + number;
  const std::string name = "--job-name=stagger-" + plan.spec().name;
  fs::create_directories(folder.path() / "shards");

  const std::string robots = "STAGGER_ROBOTS=" + slurm.robots;
  const std::string shard =
      text_of({"exec", "env", robots, slurm.program, "campaign", "shard", path, "--threads",
               threads, "--round", number, "--shards", count}) +
      " --index \"$SLURM_ARRAY_TASK_ID\"";
  round.array =
      sbatch(slurm,
             {name, "--array=0-" + std::to_string(round.shards - 1), "--cpus-per-task=" + threads,
              "--open-mode=append", "--output=" + log + "-shard-%a.log"},
             shard);
  // Whatever has become of the shards: what they have stored counts, the rest is run again.
  const std::string merge =
      text_of({"exec", "env", robots, slurm.program, "campaign", "merge", path, "--round", number});
  try {
    round.merge = sbatch(slurm,
                         {name + "-merge", "--dependency=afterany:" + round.array,
                          "--open-mode=append", "--output=" + log + "-merge.log"},
                         merge);
  } catch (...) {
    slurm_command({"scancel", round.array});
    throw;
  }
  slurm.rounds.push_back(std::move(round));
  write_slurm_plan(folder, slurm);
  return true;
}

std::string job_states(const std::string& id) {
  const ChildResult result =
      slurm_command({"squeue", "--noheader", "--array", "--format=%T", "--jobs=" + id});
  if (result.end != ChildResult::End::exited || result.code != 0) return "";
  std::map<std::string, int> counts;
  std::istringstream lines(result.out);
  for (std::string state; lines >> state;) {
    std::transform(state.begin(), state.end(), state.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    ++counts[state];
  }
  std::string text;
  for (const auto& [state, count] : counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + state;
  }
  return text;
}

std::string slurm_attempt() {
  const auto variable = [](const char* name, const char* otherwise) {
    const char* value = std::getenv(name);
    return std::string(value != nullptr ? value : otherwise);
  };
  return variable("SLURM_JOB_ID", "local") + "-" + variable("SLURM_RESTART_COUNT", "0");
}

}  // namespace stagger::server::campaign
