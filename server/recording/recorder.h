// Records the live session: what was asked for, what a push or a fall triggers, and always the last
// minute.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>
#include <variant>

#include "server/live/session_listener.h"
#include "server/live/ticket.h"
#include "server/presence.h"
#include "server/recording/catalogue.h"
#include "server/recording/chunk_maker.h"

namespace stagger::server {

struct RecorderOptions {
  std::filesystem::path folder;  ///< the data folder; made when it is missing
  std::uint64_t quota_bytes = 10'000'000'000;
};

/// What a new recording is to hold.
struct RecordingRequest {
  bool on_push = false;           ///< waits for the next push to begin, else starts at once
  double before_s = 0.0;          ///< of simulation time that has passed already, at most 60 [s]
  std::optional<double> after_s;  ///< ends by itself after that much simulation time [s]
  std::string note;
  std::vector<std::string> tags;
  bool is_protected = false;
};

struct RecordingPatch {
  std::optional<std::string> note;
  std::optional<std::vector<std::string>> tags;
  std::optional<bool> is_protected;
};

struct DiskUse {
  std::uint64_t used_bytes = 0;
  std::uint64_t quota_bytes = 0;
  std::string warning;  ///< empty: none
};

/// The simulation thread hands over what is to be recorded and never waits for a disk: what comes
/// while the queue is full is lost, counted, and told in the recording. A thread of our own packs
/// and writes.
class Recorder final : public SessionListener {
 public:
  /// What the flight recorder holds, of simulation time, and the most memory that it takes.
  static constexpr double flight_s = 60.0;
  static constexpr std::size_t flight_bytes = 256 << 20;
  /// Recordings that wait or are written at a time.
  static constexpr std::size_t max_active = 8;
  /// Recordings of falls that are kept unless protected: a campaign of falls must not drive out
  /// what was recorded on purpose.
  static constexpr std::uint64_t max_falls = 20;

  /// Makes the folder, repairs what a killed process has left, starts the thread. Throws
  /// std::runtime_error when the folder cannot be used. `presence`: in the same folder.
  Recorder(const RecorderOptions& options, const Presence& presence);
  ~Recorder() override;

  // The simulation thread.
  void start_session(const SessionPtr& session) override;
  void tick(const FramePtr& frame) override;
  void event(const EventPtr& event) override;
  void await_room(std::chrono::milliseconds patience) override;

  // Any other thread. Throw CommandError.
  RecordingInfo start(const RecordingRequest& request);
  /// Ends it; one that is armed is gone.
  RecordingInfo stop(const std::string& id);
  RecordingInfo find(const std::string& id) const;
  std::vector<RecordingInfo> list(const CatalogueQuery& query) const;
  RecordingInfo change(const std::string& id, const RecordingPatch& patch);
  void remove(const std::string& id);
  /// The file of a recording; of one that is not done it can be read as far as it is written.
  std::filesystem::path file_of(const std::string& id) const;
  DiskUse disk_use() const;

  /// Finishes all recordings and ends the thread. May be called again.
  void finish();

 private:
  using Item = std::variant<SessionPtr, FramePtr, EventPtr>;

  struct Active {
    RecordingInfo info;
    RecordingRequest request;
    std::unique_ptr<RecordingFile> file;  ///< none while it is armed
    std::optional<std::uint64_t> end_ns;  ///< log time
    bool ends_with_world = false;
  };

  std::optional<RecordingInfo> stop_own(const std::string& id);
  RecordingInfo stop_left(const std::string& id);
  void offer(Item item, bool is_frame);
  void run();

  // All below: with work_mutex_ held.
  void work_off_queue();
  void take(const SessionPtr& session);
  void take(const FramePtr& frame);
  void take(const EventPtr& event);
  void close_chunk();
  void write(Active& active, const RecorderChunk& chunk);
  void put_first(const Active& active, const std::function<void()>& begin);
  std::vector<RecorderChunkPtr> past(std::uint64_t from_ns, bool this_world_only);
  void begin_file(Active& active, std::uint64_t from_ns, bool this_world_only);
  void end(Active& active, const std::string& error = "");
  void end_those(const std::function<bool(const Active&)>& which);
  void trigger_push();
  void save_fall();
  bool make_room(std::uint64_t bytes);
  void keep_quota(std::uint64_t bytes);
  std::string quota_warning(std::uint64_t used) const;
  std::string new_id();
  Active new_active(const RecordingRequest& request, RecordingReason reason);
  std::filesystem::path path_of(const std::string& id) const;

  const RecorderOptions options_;
  const Presence& presence_;
  const std::filesystem::path folder_;  ///< of the files

  std::mutex queue_mutex_;
  std::condition_variable queue_changed_;
  std::vector<Item> queue_;
  std::size_t queued_frames_ = 0;
  bool stopping_ = false;

  mutable std::mutex work_mutex_;
  std::optional<FileLock> turn_;  ///< to repair the folder
  Catalogue catalogue_;
  ChunkMaker maker_;
  std::deque<RecorderChunkPtr> flight_;
  std::size_t flight_size_ = 0;
  std::vector<Active> active_;
  std::uint64_t last_id_ms_ = 0;
  std::uint64_t removed_ = 0;  ///< recordings, to keep the quota, since the start
  std::string warning_;
  std::thread thread_;
};

}  // namespace stagger::server
