// The table of recordings, in SQLite beside their files.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/recording/recording_info.h"

namespace stagger::server {

/// Which of the recordings a list is to hold, newest first.
struct CatalogueQuery {
  std::size_t limit = 100;
  std::string before;  ///< only ids that sort before this one; empty: all
  std::optional<std::string> tag;
  std::optional<RecordingState> state;
  std::optional<RecordingReason> reason;
};

/// Ids sort by age. Safe to use from several threads and processes. What goes wrong throws
/// std::runtime_error.
class Catalogue {
 public:
  /// Opens or makes the file; one that is broken is set aside and begun anew.
  explicit Catalogue(const std::filesystem::path& file);
  ~Catalogue();
  Catalogue(const Catalogue&) = delete;
  Catalogue& operator=(const Catalogue&) = delete;

  /// Adds the recording, or replaces all of it.
  void put(const RecordingInfo& info);
  /// The same, unless its file has gone meanwhile.
  void put(const RecordingInfo& info, const std::filesystem::path& file);
  /// Replaces what recording changes; note, tags, protection and owner stay as they are.
  void update(const RecordingInfo& info);
  /// Replaces note, tags and protection.
  void annotate(const RecordingInfo& info);
  void remove(const std::string& id);
  /// Removes one that is done and not protected, and its file with it; false when it is not, or no
  /// longer, such a one.
  bool remove_done(const std::string& id, const std::filesystem::path& file);

  std::optional<RecordingInfo> find(const std::string& id) const;
  std::vector<RecordingInfo> list(const CatalogueQuery& query) const;
  /// Bytes of all recordings.
  std::uint64_t bytes() const;
  /// The oldest that is done and not protected, of that reason when there is one.
  std::optional<RecordingInfo> oldest_removable(std::optional<RecordingReason> reason) const;
  std::uint64_t count_removable(RecordingReason reason) const;

 private:
  struct Statement;
  void open(const std::filesystem::path& file);
  void close();
  void execute(const char* sql) const;
  void write(const char* sql, const RecordingInfo& info) const;
  /// With nobody else writing meanwhile, in no other process either.
  void alone(const std::function<void()>& change) const;

  mutable std::mutex mutex_;
  struct Database;
  std::unique_ptr<Database> database_;
};

}  // namespace stagger::server
