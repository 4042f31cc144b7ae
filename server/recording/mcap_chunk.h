// A chunk of MCAP: messages go in, compressed bytes and their index come out.
#pragma once

#include "server/recording/mcap_format.h"

namespace stagger::server {

class McapChunkBuilder {
 public:
  bool empty() const { return plain_.empty(); }
  std::size_t size() const { return plain_.size(); }

  /// `time` is the log time [ns]; it never goes back within a chunk.
  void add(std::uint16_t channel, std::uint64_t time, std::string_view data);

  /// What has been added since the last call.
  McapChunk take();

 private:
  std::string plain_;
  std::string packed_;  ///< kept: a large piece taken and given back for each chunk leaves holes
  McapChunk chunk_;
  std::uint32_t sequence_ = 0;
};

/// The messages of a chunk's plain bytes, one after the other.
struct McapMessage {
  std::uint16_t channel = 0;
  std::uint64_t time = 0;  ///< [ns]
  std::string_view data;   ///< inside the plain bytes
  std::uint64_t place = 0;
};

/// A chunk's record content, read; `bytes` stay where they are in `content`.
struct McapChunkView {
  std::uint64_t start_time = 0;
  std::uint64_t end_time = 0;
  std::uint64_t plain_size = 0;
  std::uint32_t plain_crc = 0;
  std::string_view compression;
  std::string_view bytes;
};

/// Throws BadBytes.
McapChunkView view_chunk(std::string_view content);

/// The plain bytes of a chunk. Throws BadBytes when they do not come out as they should, or are
/// more than any chunk of ours holds.
std::string unpack(const McapChunkView& chunk);

/// Throws BadBytes. Records that are not messages are passed over.
std::vector<McapMessage> messages_of(std::string_view plain);

}  // namespace stagger::server
