// What of a recording is wanted: which numbers, from when to when, every how many ticks.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "server/recording/recording_reader.h"
#include "sim/strict_json.h"

namespace stagger::server {

struct Selection {
  /// Channels ("com"), components ("com.x", "preview[0].x") or "state_hash"; all when empty.
  std::optional<std::vector<std::string>> fields;
  double from_s = 0.0;  ///< since the recording's first tick, in log time [s]
  double to_s = std::numeric_limits<double>::infinity();  ///< this tick included [s]
  std::uint64_t every = 1;                                ///< each so many ticks
};

/// One number, wherever a table of channels holds it.
struct RecordedColumn {
  std::string label;  ///< "com.x", "preview[0].x", "phase_time"
  std::string unit;
  std::string channel;
  std::size_t at = 0;  ///< among the channel's values
};

/// All numbers of a channel, in the order of its values.
std::vector<RecordedColumn> columns_of(const sim::Channel& channel);

struct ChosenColumns {
  std::vector<RecordedColumn> columns;
  bool with_hash = true;
};

/// The numbers that are wanted of all the recording's worlds. What there is not goes to `errors`.
/// Throws std::runtime_error when the file cannot be read.
ChosenColumns choose_columns(const std::filesystem::path& file, const Selection& selection,
                             sim::JsonErrors& errors);

/// Where the columns' channels are in a table; nothing for a column that the table lacks.
std::vector<std::optional<std::size_t>> places_in(const FrameSchema& schema,
                                                  const std::vector<RecordedColumn>& columns);

/// Goes through a recording and tells which of its ticks and events are wanted.
class SelectionWindow {
 public:
  /// Looks up the file's first tick. Throws std::runtime_error when the file is no recording.
  SelectionWindow(const std::filesystem::path& file, const Selection& selection);

  /// Since the first tick [s].
  double elapsed(std::uint64_t time_ns) const;
  /// To be asked about every tick, in their order.
  bool takes(const RecordedTick& tick);
  bool takes(const RecordedText& event) const;
  /// A tick has come that is past the end: all that is wanted has been seen.
  bool past_end() const { return past_end_; }
  /// Log time at which the window begins, 0 when it is open there [ns].
  std::uint64_t begin_ns() const;

 private:
  double from_s_;
  double to_s_;
  std::uint64_t every_;
  std::optional<std::uint64_t> first_ns_;
  std::uint64_t count_ = 0;
  bool past_end_ = false;
};

}  // namespace stagger::server
