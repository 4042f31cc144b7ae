// `stagger campaign`: its subcommands and what they share.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "server/campaign/campaign.h"
#include "server/campaign/compare.h"
#include "server/campaign/folder.h"
#include "server/cli/folders.h"

namespace stagger::server {

struct CampaignOptions {
  enum class Action : std::uint8_t {
    run,
    validate,
    resume,
    status,
    report,
    show,
    compare,
    submit,
    shard,
    merge
  };
  Action action = Action::run;
  std::string spec;          ///< file, or "-" for standard input
  std::string folder;        ///< of a campaign
  std::string other;         ///< another one, to compare with
  std::string out;           ///< folder to make; empty: NAME.campaign
  std::string figures;       ///< folder for a report's figures; empty: none
  std::uint64_t number = 0;  ///< of a trial
  campaign::Tolerance tolerance;
  unsigned threads = 0;  ///< 0: one a core; on a cluster one
  bool slurm = false;
  std::uint64_t shards = 4;         ///< at the most, of a round
  std::uint64_t round = 0;          ///< of a shard
  std::uint64_t index = 0;          ///< of a shard
  std::vector<std::string> sbatch;  ///< arguments for it
  bool json = false;
  bool quiet = false;
};

/// Adds the command; what is parsed is left in `options`.
CLI::App* add_campaign(CLI::App& app, CampaignOptions& options);

int campaign_command(const CampaignOptions& options, const Folders& folders);

/// The plan of a specification; nullptr after a message for each error: "file:line:column: ...".
std::unique_ptr<campaign::Plan> load_plan(const std::string& name, const std::string& text,
                                          RobotLibrary& library);

/// Runs what a folder's store does not hold yet, tells how far it is and writes the files. Exit
/// code as docs/campaign.md has it.
int run_folder(const campaign::Folder& folder, const campaign::Plan& plan, campaign::Store& store,
               const CampaignOptions& options);

/// Summary, files and exit code of a campaign that has come to this end.
int conclude(const campaign::Folder& folder, const campaign::Plan& plan,
             const campaign::Store& store, campaign::End end, const CampaignOptions& options);

// On a cluster: docs/campaign.md.
int submit_campaign(const CampaignOptions& options, const Folders& folders, RobotLibrary& library);
int shard_campaign(const CampaignOptions& options, RobotLibrary& library);
int merge_campaign(const CampaignOptions& options, RobotLibrary& library);
/// Where the jobs of a campaign are; nothing when it is on no cluster.
void tell_slurm(const campaign::Folder& folder, const campaign::Store& store);

/// What a campaign found, in lines for people.
std::string summary_text(const campaign::Plan& plan, const campaign::Summary& summary);
std::string comparison_text(const campaign::CampaignComparison& comparison);

}  // namespace stagger::server
