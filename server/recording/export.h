// A recording as text: CSV with units in its header, or a JSON object a line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/recording/selection.h"

namespace stagger::server {

enum class ExportFormat : std::uint8_t { csv, ndjson };

/// Reads as it writes: bounded in memory however long the recording is.
class Export {
 public:
  /// What is wrong with the selection goes to `errors`. Throws std::runtime_error when the file is
  /// no recording.
  Export(const std::filesystem::path& file, ExportFormat format, const Selection& selection,
         sim::JsonErrors& errors);

  /// Appends a part of the text; false at the end.
  bool next(std::string& out);

 private:
  void look_up(const FrameSchema& schema);
  void write_header(std::string& out);
  void write(const RecordedWorld& world, std::string& out);
  void write(const RecordedTick& tick, std::string& out);
  void write(const RecordedText& text, std::string& out);
  void write_csv(const RecordedTick& tick, double elapsed, std::string& out);
  void write_ndjson(const RecordedTick& tick, double elapsed, std::string& out);
  const double* value(const RecordedTick& tick, std::size_t column) const;

  ExportFormat format_;
  RecordingReader reader_;
  SelectionWindow window_;
  ChosenColumns chosen_;
  bool started_ = false;
  std::size_t world_ = 0;
  const FrameSchema* schema_ = nullptr;
  std::vector<std::optional<std::size_t>> places_;  ///< of the columns' channels in schema_
};

}  // namespace stagger::server
