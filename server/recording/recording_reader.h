// A recording, item by item in the order of time: worlds, ticks, events, commands.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <variant>

#include "server/json/world_json.h"
#include "server/recording/frame_schema.h"
#include "server/recording/mcap_chunk.h"
#include "server/recording/mcap_reader.h"
#include "sim/world_command.h"

namespace stagger::server {

/// Names and encodings that writer and readers agree on.
inline constexpr const char* frame_topic = "/frame";
inline constexpr const char* event_topic = "/event";
inline constexpr const char* command_topic = "/command";
inline constexpr const char* recording_metadata = "stagger.recording";
inline constexpr const char* world_metadata = "stagger.world";
inline constexpr const char* gap_kind = "gap";  ///< event: ticks were lost before this one
inline constexpr const char* cut_journal_kind = "journal_cut";
inline constexpr std::uint64_t ns_per_tick = 1'000'000;

/// From here on the recording is of this world.
struct RecordedWorld {
  std::size_t number = 0;  ///< 0, 1, ... in this recording
  std::string session_id;
  std::string text;              ///< world_json()
  std::string robot_files;       ///< hash of the robot's files
  std::string version;           ///< of the program
  bool journal_is_whole = true;  ///< so far
  std::uint64_t epoch_ns = 0;    ///< log time of tick 0
};

struct RecordedTick {
  std::uint64_t time_ns = 0;  ///< log time
  std::uint16_t channel = 0;  ///< its number in the file
  std::shared_ptr<const FrameSchema> schema;
  RecordedFrame frame;
};

/// An event or a command, as JSON.
struct RecordedText {
  std::uint64_t time_ns = 0;
  bool is_command = false;
  std::string text;
};

using RecordedItem = std::variant<RecordedWorld, RecordedTick, RecordedText>;

/// Also of a file that was cut off. What is not readable ends it.
class RecordingReader {
 public:
  /// Throws std::runtime_error when the file is no recording.
  explicit RecordingReader(const std::filesystem::path& file);

  /// Ticks and events before this log time are passed over.
  void skip_until(std::uint64_t time_ns) { from_ns_ = time_ns; }

  std::optional<RecordedItem> next();

  /// id, reason, version, created_s.
  const std::map<std::string, std::string>& about() const { return about_; }

 private:
  std::optional<RecordedItem> from_chunk();
  std::optional<RecordedItem> take(const McapRecord& record);

  McapReader reader_;
  std::map<std::string, std::string> about_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::map<std::uint16_t, std::shared_ptr<const FrameSchema>> schemas_;
  std::string plain_;
  std::vector<McapMessage> messages_;
  std::size_t at_ = 0;
  std::size_t worlds_ = 0;
  std::uint64_t from_ns_ = 0;
};

/// The metadata that tells of a world in a file.
std::map<std::string, std::string> metadata_of(const RecordedWorld& world);
/// Whether it is the event that tells that commands after it were not kept.
bool cuts_journal(const RecordedText& text);
/// A world's configuration out of its text. Throws std::runtime_error.
WorldSpec world_of(const RecordedWorld& world);
/// A command's entry out of its text. Throws std::runtime_error.
sim::JournalEntry entry_of(const RecordedText& text);

}  // namespace stagger::server
