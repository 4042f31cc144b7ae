#include "server/recording/recorder.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <random>
#include <utility>

#include "server/json/gait_json.h"
#include "server/recording/repair.h"

namespace stagger::server {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::size_t queue_frames = 4096;  // 4 s of the wall clock's pace, some 12 MB
constexpr std::size_t queue_items = 4 * queue_frames;
constexpr auto idle_period = 50ms;
constexpr const char* turn_file = "recordings.lock";
constexpr auto folder_patience = 5s;  // then it is told who is waited for
constexpr double fall_after_s = 2.0;
constexpr double warn_share = 0.9;             // of the quota
constexpr std::uint64_t file_bytes = 1 << 16;  // what a file takes beside its chunks, more or less

/// Of a chunk in a file, its index and its place in the summary with it; a little more than it will
/// be.
std::uint64_t bytes_of(const RecorderChunk& chunk) {
  std::uint64_t bytes = chunk.data.bytes.size() + 1024;
  for (const auto& [channel, places] : chunk.data.places) bytes += 16 * places.size();
  return bytes;
}

CommandError conflict(const std::string& why) { return {CommandError::Kind::conflict, why}; }

std::string in_mb(std::uint64_t bytes) { return std::to_string(bytes / 1'000'000) + " MB"; }

double now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

fs::path made(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw std::runtime_error("the data folder " + folder.string() +
                             " cannot be made: " + error.message());
  }
  return folder;
}

/// Of servers that start at the same time one repairs first.
FileLock await_turn(const fs::path& file) {
  for (;;) {
    if (auto turn = FileLock::take(file, folder_patience)) return std::move(*turn);
    spdlog::warn("another server puts the recordings in order: waiting for {}", file.string());
  }
}

}  // namespace

Recorder::Recorder(const RecorderOptions& options, const Presence& presence)
    : options_(options),
      presence_(presence),
      folder_(made(options.folder / "recordings")),
      turn_(await_turn(options.folder / turn_file)),
      catalogue_(options.folder / "recordings.sqlite") {
  repair_recordings(folder_, presence_, catalogue_);
  turn_.reset();
  keep_quota(0);
  thread_ = std::thread([this] { run(); });
}

Recorder::~Recorder() { finish(); }

// --- The simulation thread's side.

void Recorder::offer(Item item, bool is_frame) {
  {
    const std::lock_guard lock(queue_mutex_);
    if (queue_.size() >= queue_items || (is_frame && queued_frames_ >= queue_frames)) return;
    queue_.push_back(std::move(item));
    queued_frames_ += is_frame ? 1 : 0;
  }
  // The thread looks for itself often enough: a wake-up for each tick would cost more than it.
  if (!is_frame) queue_changed_.notify_all();
}

void Recorder::start_session(const SessionPtr& session) {
  // Without it nothing that follows could be understood: it is never lost.
  const std::lock_guard lock(queue_mutex_);
  queue_.emplace_back(session);
}

void Recorder::tick(const FramePtr& frame) { offer(frame, true); }
void Recorder::event(const EventPtr& event) { offer(event, false); }

void Recorder::await_room(std::chrono::milliseconds patience) {
  std::unique_lock lock(queue_mutex_);
  if (queued_frames_ < queue_frames / 2) return;
  queue_changed_.notify_all();
  queue_changed_.wait_for(lock, patience,
                          [this] { return stopping_ || queued_frames_ < queue_frames / 2; });
}

// --- The recorder's thread.

void Recorder::run() {
  for (;;) {
    bool stopping = false;
    {
      std::unique_lock lock(queue_mutex_);
      queue_changed_.wait_for(lock, idle_period,
                              [this] { return stopping_ || queued_frames_ > queue_frames / 4; });
      stopping = stopping_;
    }
    const std::lock_guard lock(work_mutex_);
    // Whatever goes wrong with a disk must not take the server down with it.
    try {
      work_off_queue();
      if (maker_.is_due(ChunkMaker::Clock::now())) close_chunk();
      if (stopping) {
        close_chunk();
        end_those([](const Active&) { return true; });
      }
    } catch (const std::exception& error) {
      spdlog::error("recording: {}", error.what());
    }
    if (stopping) return;
  }
}

void Recorder::finish() {
  {
    const std::lock_guard lock(queue_mutex_);
    stopping_ = true;
  }
  queue_changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Recorder::work_off_queue() {
  std::vector<Item> items;
  {
    const std::lock_guard lock(queue_mutex_);
    items.swap(queue_);
    queued_frames_ = 0;
  }
  queue_changed_.notify_all();
  for (const Item& item : items) {
    std::visit([this](const auto& some) { take(some); }, item);
  }
}

void Recorder::take(const SessionPtr& session) {
  close_chunk();
  end_those([](const Active& active) { return active.ends_with_world; });
  maker_.start_world(session);
}

void Recorder::take(const FramePtr& frame) {
  maker_.add(*frame);
  const std::uint64_t now = maker_.newest_ns();
  const auto has_ended = [now](const Active& active) {
    return active.end_ns.has_value() && now >= *active.end_ns;
  };
  if (std::any_of(active_.begin(), active_.end(), has_ended)) {
    close_chunk();
    end_those(has_ended);
  } else if (maker_.is_due(ChunkMaker::Clock::now())) {
    close_chunk();
  }
}

void Recorder::take(const EventPtr& event) {
  maker_.add(*event);
  if (event->kind == "push_started") trigger_push();
  if (event->kind == "fall") save_fall();
}

void Recorder::close_chunk() {
  if (maker_.empty()) return;
  const RecorderChunkPtr chunk = maker_.take();
  flight_.push_back(chunk);
  flight_size_ += chunk->data.bytes.size();
  const auto too_old = [&](const RecorderChunk& old) {
    return static_cast<double>(chunk->data.end_time - old.data.end_time) > flight_s * ns_per_s;
  };
  while (too_old(*flight_.front()) || (flight_size_ > flight_bytes && flight_.size() > 1)) {
    flight_size_ -= flight_.front()->data.bytes.size();
    flight_.pop_front();
  }
  keep_quota(bytes_of(*chunk));
  for (Active& active : active_) {
    if (active.file != nullptr) write(active, *chunk);
  }
  end_those([](const Active& active) { return !active.info.error.empty(); });
  // Another server that shares the folder may have found the same room.
  keep_quota(0);
}

void Recorder::write(Active& active, const RecorderChunk& chunk) {
  try {
    active.file->add(chunk, active.info);
    catalogue_.update(active.info);
  } catch (const std::exception& error) {
    active.info.error = error.what();
    spdlog::error("recording {}: {}", active.info.id, error.what());
  }
}

/// The catalogue tells whose a file is before there is one: no other server takes it for left
/// behind.
void Recorder::put_first(const Active& active, const std::function<void()>& begin) {
  catalogue_.put(active.info);
  try {
    begin();
  } catch (const std::exception&) {
    catalogue_.remove(active.info.id);
    throw;
  }
}

/// What the flight recorder holds from that time on, as far as the quota has room for it: of what
/// is too much, the newest. Throws CommandError when there is none.
std::vector<RecorderChunkPtr> Recorder::past(std::uint64_t from_ns, bool this_world_only) {
  std::deque<RecorderChunkPtr> chunks;
  std::uint64_t bytes = file_bytes;
  for (const RecorderChunkPtr& chunk : flight_) {
    if (chunk->data.end_time < from_ns) continue;
    if (this_world_only && chunk->world != maker_.world()) continue;
    chunks.push_back(chunk);
    bytes += bytes_of(*chunk);
  }
  const auto cut = [&](std::uint64_t room) {
    for (; bytes > room && !chunks.empty(); chunks.pop_front()) bytes -= bytes_of(*chunks.front());
  };
  // One fall must not drive out all that was recorded before.
  const std::size_t wanted = chunks.size();
  cut(options_.quota_bytes / 2);
  if (!make_room(bytes)) {
    const std::uint64_t used = catalogue_.bytes();
    cut(options_.quota_bytes - std::min(used, options_.quota_bytes));
    if (used + bytes > options_.quota_bytes) {
      throw conflict("the recordings take all of their quota and none may be removed");
    }
  }
  if (chunks.size() < wanted) {
    spdlog::warn("recordings: their quota has room for {} of the past alone", in_mb(bytes));
  }
  return {chunks.begin(), chunks.end()};
}

void Recorder::begin_file(Active& active, std::uint64_t from_ns, bool this_world_only) {
  const auto chunks = past(from_ns, this_world_only);
  active.file = std::make_unique<RecordingFile>(path_of(active.info.id), active.info);
  active.info.state = RecordingState::recording;
  for (const RecorderChunkPtr& chunk : chunks) write(active, *chunk);
}

void Recorder::end(Active& active, const std::string& error) {
  if (!error.empty()) active.info.error = error;
  if (active.file == nullptr) {
    catalogue_.remove(active.info.id);  // armed in vain
    return;
  }
  try {
    active.file->finish(active.info);
  } catch (const std::exception& failure) {
    // What is written can be read, and is finished at the next start.
    spdlog::error("recording {}: {}", active.info.id, failure.what());
    if (active.info.error.empty()) active.info.error = failure.what();
  }
  active.file.reset();
  active.info.state = RecordingState::done;
  catalogue_.update(active.info);
}

void Recorder::end_those(const std::function<bool(const Active&)>& which) {
  for (Active& active : active_) {
    if (which(active)) end(active);
  }
  std::erase_if(active_, which);
}

void Recorder::trigger_push() {
  const std::uint64_t now = maker_.newest_ns();
  for (Active& active : active_) {
    if (active.file != nullptr) continue;
    const auto before = static_cast<std::uint64_t>(active.request.before_s * ns_per_s);
    active.end_ns = now + static_cast<std::uint64_t>(active.request.after_s.value_or(0) * ns_per_s);
    active.ends_with_world = true;
    try {
      begin_file(active, now - before, true);
    } catch (const std::exception& error) {
      active.info.error = error.what();
      spdlog::error("recording {}: {}", active.info.id, error.what());
    }
  }
}

void Recorder::save_fall() {
  const bool saved_already = std::any_of(active_.begin(), active_.end(), [](const Active& active) {
    return active.info.reason == RecordingReason::fall;
  });
  if (saved_already) return;
  try {
    while (catalogue_.count_removable(RecordingReason::fall) >= max_falls) {
      const auto oldest = catalogue_.oldest_removable(RecordingReason::fall);
      if (oldest) catalogue_.remove_done(oldest->id, path_of(oldest->id));
    }
    Active fall = new_active({}, RecordingReason::fall);
    const std::uint64_t now = maker_.newest_ns();
    fall.end_ns = now + static_cast<std::uint64_t>(fall_after_s * ns_per_s);
    fall.ends_with_world = true;
    put_first(fall, [&] { begin_file(fall, 0, true); });
    active_.push_back(std::move(fall));
  } catch (const std::exception& error) {
    spdlog::error("the recording of a fall: {}", error.what());
  }
}

/// Removes the oldest that may go until there is room for so much more; false when there is none of
/// them left.
bool Recorder::make_room(std::uint64_t bytes) {
  for (;;) {
    const std::uint64_t used = catalogue_.bytes();
    if (used + bytes <= options_.quota_bytes) return true;
    const auto oldest = catalogue_.oldest_removable({});
    if (!oldest) return false;
    // Another server that shares the folder may have been quicker, or a user may have protected it.
    if (catalogue_.remove_done(oldest->id, path_of(oldest->id))) {
      spdlog::warn(
          "recordings take {}, and there is no room for more within their quota of {}: {} has been "
          "removed",
          in_mb(used), in_mb(options_.quota_bytes), oldest->id);
      ++removed_;
    }
  }
}

/// Before each file that is written takes so much more: where there is no room, recording ends.
void Recorder::keep_quota(std::uint64_t bytes) {
  const auto is_written = [](const Active& active) { return active.file != nullptr; };
  const auto files =
      static_cast<std::uint64_t>(std::count_if(active_.begin(), active_.end(), is_written));
  if (!make_room(files * (bytes + file_bytes)) && files > 0) {
    for (Active& active : active_) {
      if (is_written(active)) end(active, "the quota of the disk is used up");
    }
    std::erase_if(active_,
                  [](const Active& active) { return active.info.state == RecordingState::done; });
  }
  const std::string before = std::exchange(warning_, quota_warning(catalogue_.bytes()));
  if (!warning_.empty() && before.empty()) spdlog::warn("recordings: {}", warning_);
}

std::string Recorder::quota_warning(std::uint64_t used) const {
  if (used + file_bytes > options_.quota_bytes && !catalogue_.oldest_removable({})) {
    return "the quota is used up and nothing may be removed: nothing is recorded";
  }
  if (removed_ > 0) {
    return "the quota was used up: " + std::to_string(removed_) +
           " recordings have been removed, the oldest that were not protected first";
  }
  if (static_cast<double>(used) > warn_share * static_cast<double>(options_.quota_bytes)) {
    return "the quota is nearly used up: the oldest recordings that are not protected go first";
  }
  return "";
}

fs::path Recorder::path_of(const std::string& id) const { return folder_ / (id + ".mcap"); }

std::string Recorder::new_id() {
  // Sorts by age, also within a millisecond; what comes at random keeps two servers apart.
  const auto ms = static_cast<std::uint64_t>(now_s() * 1000.0);
  last_id_ms_ = std::max(ms, last_id_ms_ + 1);
  const auto seconds = static_cast<std::time_t>(last_id_ms_ / 1000);
  std::tm date{};
  gmtime_r(&seconds, &date);
  char text[96];
  std::snprintf(text, sizeof text, "%04d%02d%02d-%02d%02d%02d-%03d-%04x", date.tm_year + 1900,
                date.tm_mon + 1, date.tm_mday, date.tm_hour, date.tm_min, date.tm_sec,
                static_cast<int>(last_id_ms_ % 1000), std::random_device{}() & 0xffffU);
  return text;
}

Recorder::Active Recorder::new_active(const RecordingRequest& request, RecordingReason reason) {
  Active active;
  active.request = request;
  active.info.id = new_id();
  active.info.reason = reason;
  active.info.created_s = now_s();
  active.info.version = STAGGER_VERSION;
  active.info.owner = presence_.name();
  active.info.note = request.note;
  active.info.tags = request.tags;
  active.info.is_protected = request.is_protected;
  if (maker_.world() != nullptr) {
    const SessionInfo& session = *maker_.world()->session;
    active.info.robot = session.robot;
    active.info.plant = name_of(session.plant);
    active.info.session_id = session.id;
    active.info.seed = session.seed;
  }
  return active;
}

// --- What other threads ask for.

RecordingInfo Recorder::start(const RecordingRequest& request) {
  const std::lock_guard lock(work_mutex_);
  if (active_.size() >= max_active) {
    throw conflict("as many recordings as are possible at a time are active; stop one");
  }
  work_off_queue();
  close_chunk();
  Active active =
      new_active(request, request.on_push ? RecordingReason::push : RecordingReason::manual);
  if (request.on_push) {
    active.info.state = RecordingState::armed;
    catalogue_.put(active.info);
  } else {
    const std::uint64_t now = maker_.newest_ns();
    // Without a past, all that is held is over already.
    const auto before = static_cast<std::uint64_t>(request.before_s * ns_per_s);
    put_first(active,
              [&] { begin_file(active, request.before_s > 0.0 ? now - before : now + 1, false); });
    if (request.after_s) {
      active.end_ns = now + static_cast<std::uint64_t>(*request.after_s * ns_per_s);
    }
  }
  if (active.end_ns && *active.end_ns <= maker_.newest_ns()) {
    end(active);
    return active.info;
  }
  active_.push_back(std::move(active));
  return active_.back().info;
}

RecordingInfo Recorder::stop(const std::string& id) {
  if (auto info = stop_own(id)) return *info;
  return stop_left(id);
}

std::optional<RecordingInfo> Recorder::stop_own(const std::string& id) {
  const std::lock_guard lock(work_mutex_);
  work_off_queue();
  close_chunk();
  const auto found = std::find_if(active_.begin(), active_.end(),
                                  [&id](const Active& active) { return active.info.id == id; });
  if (found == active_.end()) return std::nullopt;
  end(*found);
  RecordingInfo info = found->info;
  info.state = RecordingState::done;
  active_.erase(found);
  keep_quota(0);  // its summary has come, too
  return info;
}

/// Done already, or left behind by a server that is gone. Its file may take long: nobody waits.
RecordingInfo Recorder::stop_left(const std::string& id) {
  RecordingInfo info = find(id);
  if (info.state == RecordingState::done) return info;
  if (presence_.is_another(info.owner)) throw conflict("another server records " + id);
  const auto turn = FileLock::take(options_.folder / turn_file);
  if (!turn) throw conflict("another server puts the recordings in order; try again");
  repair_recording(path_of(id), catalogue_);
  info.state = RecordingState::done;  // one that was armed is gone
  return catalogue_.find(id).value_or(info);
}

RecordingInfo Recorder::find(const std::string& id) const {
  auto info = catalogue_.find(id);
  if (!info) throw CommandError(CommandError::Kind::not_found, "there is no recording " + id);
  return *info;
}

std::vector<RecordingInfo> Recorder::list(const CatalogueQuery& query) const {
  return catalogue_.list(query);
}

RecordingInfo Recorder::change(const std::string& id, const RecordingPatch& patch) {
  const std::lock_guard lock(work_mutex_);
  RecordingInfo info = find(id);
  if (patch.note) info.note = *patch.note;
  if (patch.tags) info.tags = *patch.tags;
  if (patch.is_protected) info.is_protected = *patch.is_protected;
  catalogue_.annotate(info);
  return info;
}

void Recorder::remove(const std::string& id) {
  const std::lock_guard lock(work_mutex_);
  const RecordingInfo info = find(id);
  if (info.state != RecordingState::done) throw conflict("recording " + id + " is active; stop it");
  if (info.is_protected) throw conflict("recording " + id + " is protected");
  if (catalogue_.remove_done(id, path_of(id))) return;
  find(id);
  throw conflict("recording " + id + " has just been changed by another server");
}

fs::path Recorder::file_of(const std::string& id) const {
  const RecordingInfo info = find(id);
  if (info.state == RecordingState::armed) {
    throw conflict("recording " + id + " waits for its push: nothing is written yet");
  }
  return path_of(info.id);
}

DiskUse Recorder::disk_use() const {
  const std::lock_guard lock(work_mutex_);
  return {catalogue_.bytes(), options_.quota_bytes, warning_};
}

}  // namespace stagger::server
