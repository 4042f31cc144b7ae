// What is known of a recording without reading it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stagger::server {

enum class RecordingState : std::uint8_t { armed, recording, done };
enum class RecordingReason : std::uint8_t { manual, push, fall };

struct RecordingInfo {
  std::string id;  ///< letters, digits and dashes; the file is <id>.mcap
  RecordingState state = RecordingState::recording;
  RecordingReason reason = RecordingReason::manual;
  double created_s = 0.0;  ///< since 1970 [s]
  std::string robot;       ///< of the last world, as all below
  std::string plant;
  std::uint64_t seed = 0;
  std::string session_id;
  std::string version;
  std::uint64_t worlds = 0;  ///< a reset begins one more
  std::uint64_t ticks = 0;
  std::uint64_t lost_ticks = 0;
  std::uint64_t pushes = 0;  ///< begun
  std::uint64_t falls = 0;
  std::uint64_t bytes = 0;
  std::string error;  ///< why it ended before its time
  std::string owner;  ///< the server that began it, by its Presence; empty: none that is known

  // What users may change.
  std::string note;
  std::vector<std::string> tags;
  bool is_protected = false;
};

std::string_view name_of(RecordingState state);
std::string_view name_of(RecordingReason reason);
std::optional<RecordingState> recording_state_of(std::string_view name);
std::optional<RecordingReason> recording_reason_of(std::string_view name);

}  // namespace stagger::server
