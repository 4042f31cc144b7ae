// Turns what the simulation tells into chunks, each of one world and at most half a second of wall
// time.
#pragma once

#include <chrono>
#include <functional>
#include <map>

#include "server/recording/mcap_chunk.h"
#include "server/recording/recording_file.h"

namespace stagger::server {

class ChunkMaker {
 public:
  using Clock = std::chrono::steady_clock;

  /// What comes after belongs to this world. The present chunk must have been taken.
  void start_world(const SessionPtr& session);
  void add(const FrameMessage& frame);
  void add(const EventMessage& event);

  bool empty() const { return builder_.empty(); }
  /// Is the chunk so old or so large that it has to be taken?
  bool is_due(Clock::time_point now) const;
  RecorderChunkPtr take();

  /// Log time of the newest tick [ns].
  std::uint64_t newest_ns() const { return newest_ns_; }
  const RecorderWorldPtr& world() const { return world_; }

 private:
  void begin();
  void add_commands(std::uint64_t last_tick);
  void tell(const FrameMessage& frame, const char* kind, const std::string& text, double ticks);
  std::uint64_t time_of(std::uint64_t tick);

  RecorderWorldPtr world_;
  McapChunkBuilder builder_;
  RecorderChunk chunk_;
  Clock::time_point opened_;
  std::size_t commands_ = 0;  ///< of the world's journal that have been added
  bool told_cut_journal_ = false;
  std::uint64_t expected_tick_ = 0;
  std::uint64_t newest_ns_ = 0;
  std::string buffer_;
  std::map<std::string, std::pair<std::uint16_t, std::shared_ptr<const FrameSchema>>> schemas_;
  std::map<std::filesystem::path, std::string> robot_files_;
};

}  // namespace stagger::server
