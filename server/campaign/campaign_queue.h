// Campaigns that a server runs behind its live simulation: one at a time, kept in a folder each.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "server/campaign/campaign.h"
#include "server/campaign/results.h"
#include "server/presence.h"
#include "server/robot_library.h"
#include "sim/strict_json.h"

namespace stagger::server::campaign {

enum class QueueState : std::uint8_t {
  queued,
  running,
  cancelling,   ///< trials under way are being finished
  done,         ///< ran to its end
  cancelled,    ///< somebody asked for it; what was run is kept
  interrupted,  ///< the server stopped
  failed        ///< it cannot go on: `error` says why
};
std::string_view name_of(QueueState state);
std::optional<QueueState> queue_state_of(std::string_view name);

/// What is told of one campaign.
struct QueueItem {
  std::uint64_t id = 0;  ///< ms since 1970 at which it was asked for
  std::string name;
  QueueState state = QueueState::queued;
  Counts counts;
  std::uint64_t most = 0;       ///< trials at the most
  bool bisection = false;       ///< then fewer trials than `most` are likely
  std::optional<double> eta_s;  ///< while it runs, to `most` [s]
  std::optional<bool> passed;   ///< once it is done: all thresholds hold, no trial is invalid
  std::string error;            ///< empty: none
};

/// A specification that is not taken; its errors point into it.
class SpecRefused : public std::runtime_error {
 public:
  explicit SpecRefused(sim::JsonErrors list)
      : std::runtime_error("the specification is not valid"), errors(std::move(list)) {}
  sim::JsonErrors errors;
};

/// Safe to use from several threads, and by several servers in one folder: each runs what it was
/// asked for, and tells of what the others run. Throws CommandError for what there is not, or what
/// does not go now. Its threads get what time the others leave.
class CampaignQueue {
 public:
  static constexpr std::size_t most_waiting = 16;
  static constexpr std::size_t most_kept = 200;
  static constexpr std::uint64_t most_trials = 100'000;  ///< of one campaign
  /// Called from any thread, for every change of state, and of a campaign that runs at most once a
  /// second.
  using Listener = std::function<void(const QueueItem&)>;

  /// `folder` is made when it is needed. What a server that is gone has left unfinished is
  /// interrupted.
  CampaignQueue(std::filesystem::path folder, RobotLibrary& library, const Presence& presence,
                Listener listener);
  ~CampaignQueue();
  CampaignQueue(const CampaignQueue&) = delete;
  CampaignQueue& operator=(const CampaignQueue&) = delete;

  /// Throws SpecRefused, and CommandError (busy) when too many wait or are kept.
  QueueItem add(const std::string& specification);
  QueueItem find(std::uint64_t id);
  /// Newest first, those with an id below `before`.
  std::vector<QueueItem> list(std::uint64_t before, std::size_t limit,
                              std::optional<QueueState> state);
  /// Trials that have been run are kept.
  QueueItem cancel(std::uint64_t id);
  /// Goes on with one that was interrupted or cancelled.
  QueueItem resume(std::uint64_t id);
  /// Deletes one that neither waits nor runs.
  void remove(std::uint64_t id);
  /// The file that it left when it ended or, while it waits or runs, what the file would hold now.
  /// Not to be read on when the queue is gone.
  Results results(std::uint64_t id, OutputFile file);

  /// Starts no more trials, and is back when those under way have ended or the time is up; false:
  /// some still run, and the process may only be left by std::_Exit().
  bool stop(std::chrono::milliseconds patience);

 private:
  struct Entry {
    QueueItem item;
    std::string owner;  ///< of one that waits or runs: the server, by its Presence
    std::string saved;  ///< what the folder said of it when it was last looked at
    std::atomic<bool> cancel{false};
    std::shared_ptr<const Plan> plan;  ///< while it waits or runs; may be missing until it runs
  };
  using EntryPtr = std::shared_ptr<Entry>;

  /// Nobody else adds, resumes or deletes campaigns while it is held; taken before mutex_.
  FileLock alone() const;
  // With mutex_ held.
  bool is_ours(const Entry& entry) const;
  void read(Entry& entry) const;
  void refresh();
  Entry& changeable(std::uint64_t id);

  void work();
  void run(Entry& entry);
  End run_trials(Entry& entry);
  void finish(Entry& entry, QueueState state, const std::string& error);
  void tell(const QueueItem& item) const;
  void save(Entry& entry) const;              // with mutex_ held
  EntryPtr entry_of(std::uint64_t id) const;  // with mutex_ held
  /// The same as its folder tells now, if it is not ours.
  EntryPtr current(std::uint64_t id);
  std::filesystem::path path_of(std::uint64_t id) const { return folder_ / std::to_string(id); }

  const std::filesystem::path folder_;
  RobotLibrary& library_;
  const Presence& presence_;
  const Listener listener_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::uint64_t, EntryPtr> entries_;
  std::uint64_t last_id_ = 0;
  std::atomic<bool> stopping_{false};
  bool idle_ = false;  ///< the thread has ended
  ResultsReader reader_;
  std::mutex files_mutex_;  ///< no folder goes while files in it are being opened
  std::thread thread_;
};

}  // namespace stagger::server::campaign
