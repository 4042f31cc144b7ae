// One recording's file: a file of MCAP that always has a world's description and journal before
// what happened in that world.
#pragma once

#include <memory>

#include "server/recording/frame_schema.h"
#include "server/recording/mcap_file.h"
#include "server/recording/mcap_writer.h"
#include "server/recording/recording_info.h"

namespace stagger::server {

/// Numbers of the channels; those of frames begin behind them, one for each table of channels.
inline constexpr std::uint16_t event_channel = 1;
inline constexpr std::uint16_t command_channel = 2;
inline constexpr std::uint16_t first_frame_channel = 3;

/// A world as recordings see it.
struct RecorderWorld {
  SessionPtr session;
  std::uint64_t epoch_ns = 0;  ///< log time of tick 0
  std::uint16_t frame_channel = 0;
  std::shared_ptr<const FrameSchema> schema;
  std::string robot_files;  ///< hash of the robot's files
};

using RecorderWorldPtr = std::shared_ptr<const RecorderWorld>;

/// A second or less of one world, packed: held by the flight recorder, written to any number of
/// files.
struct RecorderChunk {
  RecorderWorldPtr world;
  McapChunk data;
  std::size_t first_command = 0;  ///< how many of the journal's entries came before it
  std::uint64_t ticks = 0;
  std::uint64_t lost_ticks = 0;
  std::uint64_t pushes = 0;
  std::uint64_t falls = 0;
};

using RecorderChunkPtr = std::shared_ptr<const RecorderChunk>;

/// The message of a command, and of an event: JSON.
std::string command_text(const sim::JournalEntry& entry);

/// What a file begins with. `about`: id, reason, version, created_s.
void write_beginning(const std::map<std::string, std::string>& about, McapWriter& writer);
/// A schema and a channel of that number, for the frames of one table of channels.
void write_frame_channel(std::uint16_t number, const FrameSchema& schema, McapWriter& writer);

class RecordingFile {
 public:
  /// Makes the file. Throws std::system_error, as everything here, when the disk does not take it.
  RecordingFile(const std::filesystem::path& file, const RecordingInfo& info);

  /// Adds the chunk, and counts it in `info`.
  void add(const RecorderChunk& chunk, RecordingInfo& info);
  void finish(RecordingInfo& info);

 private:
  void begin_world(const RecorderChunk& chunk, RecordingInfo& info);

  McapFile file_;
  McapWriter writer_;
  RecorderWorldPtr world_;
};

}  // namespace stagger::server
