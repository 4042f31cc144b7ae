#include "server/recording/chunk_maker.h"

#include <algorithm>

#include "server/json/stream_json.h"
#include "server/recording/recording_reader.h"
#include "server/recording/robot_files.h"

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

// A process that is killed loses what is not yet written: half of the second that is promised.
constexpr auto longest_chunk = 500ms;
constexpr std::size_t largest_chunk = 4 << 20;  // plain bytes: 2 to 4 s of ticks

std::uint64_t wall_ns() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count());
}

}  // namespace

void ChunkMaker::start_world(const SessionPtr& session) {
  auto world = std::make_shared<RecorderWorld>();
  world->session = session;
  // Simulation time on top of the wall clock at the world's start; log time never goes back, also
  // when worlds have run faster than the clock.
  world->epoch_ns = std::max(wall_ns(), newest_ns_ + ns_per_tick);
  auto schema = std::make_shared<const FrameSchema>(session->channels);
  const auto number = static_cast<std::uint16_t>(first_frame_channel + schemas_.size());
  // The same table has the same number, however often the world is reset.
  const auto known = schemas_.try_emplace(schema->channels_text(), number, schema).first->second;
  world->frame_channel = known.first;
  world->schema = known.second;
  world->robot_files = robot_files_hash(session->config.robot->folder);
  world_ = std::move(world);
  commands_ = 0;
  expected_tick_ = 0;
  told_cut_journal_ = false;
}

std::uint64_t ChunkMaker::time_of(std::uint64_t tick) {
  newest_ns_ = std::max(newest_ns_, world_->epoch_ns + tick * ns_per_tick);
  return newest_ns_;
}

void ChunkMaker::begin() {
  if (!builder_.empty()) return;
  opened_ = Clock::now();
  chunk_ = {};
  chunk_.world = world_;
  chunk_.first_command = commands_;
}

void ChunkMaker::add_commands(std::uint64_t last_tick) {
  for (const sim::JournalEntry& entry : world_->session->journal->entries(commands_, last_tick)) {
    builder_.add(command_channel, time_of(entry.tick), command_text(entry));
    ++commands_;
  }
}

void ChunkMaker::tell(const FrameMessage& frame, const char* kind, const std::string& text,
                      double ticks) {
  EventMessage event;
  event.tick = frame.frame.tick;
  event.time = frame.frame.time;
  event.kind = kind;
  event.text = text;
  event.values = {{"ticks", ticks}};
  builder_.add(event_channel, time_of(event.tick), event_text(event));
}

void ChunkMaker::add(const FrameMessage& frame) {
  if (world_ == nullptr || frame.session != world_->session) return;
  begin();
  const std::uint64_t tick = frame.frame.tick;
  add_commands(tick);
  if (tick > expected_tick_) {
    const std::uint64_t lost = tick - expected_tick_;
    chunk_.lost_ticks += lost;
    tell(frame, gap_kind, std::to_string(lost) + " ticks before this one were not recorded",
         static_cast<double>(lost));
  }
  if (!told_cut_journal_ && !world_->session->journal->complete()) {
    told_cut_journal_ = true;
    tell(frame, cut_journal_kind, "more commands than are kept: no replay beyond this tick", 0.0);
  }
  expected_tick_ = tick + 1;
  buffer_.clear();
  world_->schema->write(frame, buffer_);
  builder_.add(world_->frame_channel, time_of(tick), buffer_);
  ++chunk_.ticks;
}

void ChunkMaker::add(const EventMessage& event) {
  if (world_ == nullptr) return;
  begin();
  if (event.kind == "push_started") ++chunk_.pushes;
  if (event.kind == "fall") ++chunk_.falls;
  // A command's event tells the tick to come: its time is that of the tick before.
  newest_ns_ = std::max(newest_ns_, world_->epoch_ns);
  builder_.add(event_channel, newest_ns_, event_text(event));
}

bool ChunkMaker::is_due(Clock::time_point now) const {
  return !builder_.empty() && (builder_.size() > largest_chunk || now - opened_ > longest_chunk);
}

RecorderChunkPtr ChunkMaker::take() {
  auto chunk = std::make_shared<RecorderChunk>(std::move(chunk_));
  chunk->data = builder_.take();
  return chunk;
}

}  // namespace stagger::server
