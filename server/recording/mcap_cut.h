// A part of a recording as a recording of its own: again an MCAP, chunked and indexed, that can be
// read and replayed.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "server/recording/frame_selection.h"
#include "server/recording/mcap_writer.h"

namespace stagger::server {

inline constexpr const char* selection_metadata = "stagger.selection";

/// Of ticks and events what is selected; of worlds and commands all from the beginning on, which a
/// replay needs. Reads as it writes: bounded in memory however long the recording is. The recording
/// need not be finished; the cut is.
class McapCut {
 public:
  /// What is wrong with the selection goes to `errors`. Throws std::runtime_error when the file is
  /// no recording.
  McapCut(const std::filesystem::path& file, const Selection& selection, sim::JsonErrors& errors);
  McapCut(const McapCut&) = delete;
  McapCut& operator=(const McapCut&) = delete;

  /// Appends a part of the file; false at the end.
  bool next(std::string& out);

 private:
  void write(const RecordedWorld& world);
  void write(const RecordedTick& tick);
  void write(const RecordedText& text);
  const FrameSelection& selection_of(const RecordedTick& tick);
  void close_chunk();

  RecordingReader reader_;
  SelectionWindow window_;
  std::vector<RecordedColumn> columns_;
  std::string bytes_;  ///< made, and not yet taken
  McapWriter writer_;
  McapChunkBuilder chunk_;
  std::map<std::shared_ptr<const FrameSchema>, FrameSelection> frames_;
  std::string buffer_;
};

}  // namespace stagger::server
