// Reads an MCAP file from its beginning, whether it was finished or cut off, and finishes one that
// was cut off.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>

#include "server/recording/mcap_format.h"

namespace stagger::server {

struct McapRecord {
  McapOp op = McapOp::header;
  std::uint64_t offset = 0;  ///< in the file
  std::string content;
};

/// Bounded in memory by the largest record.
class McapReader {
 public:
  /// Throws std::runtime_error when the file cannot be read or is no MCAP.
  explicit McapReader(const std::filesystem::path& file);

  /// The next record of the data section; nothing at its end, or where the file was cut off or is
  /// no longer MCAP.
  /// Without chunks: theirs, and their indexes', contents are passed over.
  std::optional<McapRecord> next(bool with_chunks = true);

  /// After the last record: the data section ended as it should.
  bool complete() const { return complete_; }
  /// Where the record after the last one that was read begins.
  std::uint64_t offset() const { return offset_; }

 private:
  std::ifstream in_;
  std::uint64_t size_ = 0;
  std::uint64_t offset_ = 0;
  bool complete_ = false;
};

/// Throws BadBytes.
McapSchema read_schema(std::string_view content);
McapChannel read_channel(std::string_view content);
std::pair<std::string, std::map<std::string, std::string>> read_metadata(std::string_view content);

/// Whether the file ends as a finished one does.
bool is_finished(const std::filesystem::path& file);

/// Cuts off what is not whole, and writes the summary. Throws std::runtime_error when the file is
/// no MCAP or cannot be written.
void repair_mcap(const std::filesystem::path& file);

}  // namespace stagger::server
