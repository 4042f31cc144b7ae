// The results of one campaign in one SQLite file: written trial by trial, read at any time.
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/campaign/record.h"
#include "server/campaign/sqlite.h"

namespace stagger::server::campaign {

/// How many trials there are of each kind.
struct Counts {
  std::uint64_t trials = 0;
  std::uint64_t recovered = 0;
  std::uint64_t fell = 0;
  std::uint64_t timeout = 0;
  std::uint64_t invalid = 0;
  std::uint64_t passed = 0;
  std::uint64_t twice = 0;       ///< run twice
  std::uint64_t mismatches = 0;  ///< of these, not the same
};

/// Safe to use from many threads. Each trial is one transaction: a process that is killed loses
/// what it was running and nothing else, a machine that loses its power at most the last few trials
/// (they are run again). Other processes may read meanwhile. Errors of the file throw SqliteError.
class Store final : public Known {
 public:
  static constexpr std::size_t page_size = 1000;  ///< trials
  enum class Access : std::uint8_t {
    read,
    write,
    /// Reads it as it is when it is opened, whatever others write meanwhile. For a short time: the
    /// write-ahead log grows for as long, and nobody may write a store with a rollback journal.
    snapshot
  };
  /// How SQLite keeps its promises: the write-ahead log is quick and lets others read, but wants a
  /// local disk; the rollback journal does on a shared file system, for one process a file.
  enum class Journal : std::uint8_t { wal, rollback };

  /// A new file that holds no trial; throws when the file exists. `specification` as it was
  /// written.
  static void create(const std::filesystem::path& file, const std::string& specification,
                     Journal journal = Journal::wal);
  Store(const std::filesystem::path& file, Access access);

  const std::string& specification() const { return specification_; }
  /// Of the program that began the campaign.
  const std::string& version() const { return version_; }

  /// Adds a trial; the first result of a trial stays. False when there was one.
  bool put(const Record& record);
  std::uint64_t count() const override;
  std::optional<Verdict> verdict(std::uint64_t number) const override;
  std::optional<Record> find(std::uint64_t number) const;
  Counts counts() const;
  /// The trials from this number on, by number, page_size at the most. Fewer: there are no more.
  std::vector<Record> page(std::uint64_t from) const;
  /// Calls for every trial, by number. The file is read in pages: others may write meanwhile.
  void for_each(const std::function<void(const Record&)>& visit) const;

  /// Takes the trials of another file of the same campaign, without counting any twice. Throws
  /// std::runtime_error when the other is of another campaign or version, or when both hold a trial
  /// with different results.
  void merge(const Store& other);

 private:
  void count_in(const Record& record);
  static Record row(const Statement& statement);

  std::filesystem::path file_;
  mutable std::mutex mutex_;
  mutable Database database_;
  std::string specification_;
  std::string version_;
  Counts counts_;
  mutable std::optional<Statement> insert_;
  mutable std::optional<Statement> find_;
  mutable std::optional<Statement> page_;
};

/// Hash over all results, by number: the same for the same campaign, however it was run.
std::uint64_t results_hash(const Store& store);

}  // namespace stagger::server::campaign
