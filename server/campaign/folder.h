// The folder of a campaign: its store, its lock and its files.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/campaign/output.h"
#include "server/campaign/summary.h"
#include "server/file_lock.h"

namespace stagger::server::campaign {

class Folder {
 public:
  explicit Folder(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path store() const { return path_ / "campaign.sqlite"; }
  bool holds_campaign() const { return std::filesystem::exists(store()); }

  /// Makes the folder and an empty store in it. Throws std::runtime_error when there is a campaign
  /// already, or when it cannot be written.
  void create(const std::string& specification, Store::Journal journal = Store::Journal::wal) const;
  /// Writes summary.json, trials.csv, trials.ndjson, junit.xml and report.html, each of them whole
  /// or not at all.
  void write_files(const Plan& plan, const Store& store, const Summary& summary) const;
  /// Writes what that file would hold, of the trials that the store has.
  void write(OutputFile file, std::ostream& out, const Plan& plan, const Store& store,
             const Summary& summary) const;
  std::filesystem::path path_of(OutputFile file) const { return path_ / file_name(file); }
  /// Deletes the files that write_files() wrote: more trials are about to come.
  void remove_files() const;
  /// Writes report.html alone; its path.
  std::filesystem::path write_report(const Plan& plan, const Store& store,
                                     const Summary& summary) const;

 private:
  std::filesystem::path path_;
};

/// Writes the report's figures to a folder, which it makes; their paths.
std::vector<std::filesystem::path> write_figures(const std::filesystem::path& folder,
                                                 const Plan& plan, const Store& store,
                                                 const Summary& summary);

/// While it lives no other process runs the campaign. A process that is killed lets go of it.
class FolderLock {
 public:
  /// Throws std::runtime_error when another process runs it.
  explicit FolderLock(const Folder& folder);

 private:
  std::optional<FileLock> lock_;
};

}  // namespace stagger::server::campaign
