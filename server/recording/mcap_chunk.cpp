#include "server/recording/mcap_chunk.h"

#include <zstd.h>

#include <algorithm>

#include "server/recording/bytes.h"

namespace stagger::server {
namespace {

// The quickest of the ordinary levels: numbers with noise have little to give
// (tests/bench/recording_size.mjs).
constexpr int zstd_level = 1;
constexpr std::uint64_t most_plain_bytes = 256ULL << 20;

}  // namespace

void McapChunkBuilder::add(std::uint16_t channel, std::uint64_t time, std::string_view data) {
  chunk_.start_time = plain_.empty() ? time : std::min(chunk_.start_time, time);
  chunk_.end_time = std::max(chunk_.end_time, time);
  chunk_.places[channel].emplace_back(time, plain_.size());
  put(plain_, static_cast<std::uint8_t>(McapOp::message));
  put(plain_, static_cast<std::uint64_t>(2 + 4 + 8 + 8 + data.size()));
  put(plain_, channel);
  put(plain_, ++sequence_);
  put(plain_, time);
  put(plain_, time);
  plain_ += data;
}

McapChunk McapChunkBuilder::take() {
  McapChunk chunk = std::move(chunk_);
  chunk_ = {};
  chunk.plain_size = plain_.size();
  chunk.plain_crc = crc_over(0, plain_);
  chunk.compression = "zstd";
  packed_.resize(ZSTD_compressBound(plain_.size()));
  const std::size_t size =
      ZSTD_compress(packed_.data(), packed_.size(), plain_.data(), plain_.size(), zstd_level);
  if (ZSTD_isError(size) != 0) {
    chunk.compression.clear();
    chunk.bytes = plain_;
  } else {
    chunk.bytes.assign(packed_, 0, size);
  }
  // The flight recorder holds many of them.
  for (auto& [channel, places] : chunk.places) places.shrink_to_fit();
  plain_.clear();
  return chunk;
}

McapChunkView view_chunk(std::string_view content) {
  ByteReader in(content);
  McapChunkView chunk;
  chunk.start_time = in.number<std::uint64_t>();
  chunk.end_time = in.number<std::uint64_t>();
  chunk.plain_size = in.number<std::uint64_t>();
  chunk.plain_crc = in.number<std::uint32_t>();
  chunk.compression = in.text();
  chunk.bytes = in.take(in.number<std::uint64_t>());
  return chunk;
}

std::string unpack(const McapChunkView& chunk) {
  if (chunk.plain_size > most_plain_bytes) throw BadBytes("a chunk is larger than any of ours");
  std::string plain;
  if (chunk.compression.empty()) {
    plain = chunk.bytes;
  } else if (chunk.compression == "zstd") {
    // The size that the frame itself tells is checked first: nothing is made room for that is not
    // there.
    if (ZSTD_getFrameContentSize(chunk.bytes.data(), chunk.bytes.size()) != chunk.plain_size) {
      throw BadBytes("a chunk is not as large as it says");
    }
    plain.resize(chunk.plain_size);
    const std::size_t size =
        ZSTD_decompress(plain.data(), plain.size(), chunk.bytes.data(), chunk.bytes.size());
    if (ZSTD_isError(size) != 0) throw BadBytes("a chunk does not unpack");
    plain.resize(size);
  } else {
    throw BadBytes("a chunk is packed as \"" + std::string(chunk.compression) + "\"; known: zstd");
  }
  if (plain.size() != chunk.plain_size) throw BadBytes("a chunk is not as large as it says");
  if (chunk.plain_crc != 0 && crc_over(0, plain) != chunk.plain_crc) {
    throw BadBytes("a chunk's checksum is wrong");
  }
  return plain;
}

std::vector<McapMessage> messages_of(std::string_view plain) {
  std::vector<McapMessage> messages;
  ByteReader in(plain);
  while (in.left() > 0) {
    const std::uint64_t place = plain.size() - in.left();
    const auto op = static_cast<McapOp>(in.number<std::uint8_t>());
    ByteReader record(in.take(in.number<std::uint64_t>()));
    if (op != McapOp::message) continue;
    McapMessage message;
    message.place = place;
    message.channel = record.number<std::uint16_t>();
    record.number<std::uint32_t>();
    message.time = record.number<std::uint64_t>();
    record.number<std::uint64_t>();
    message.data = record.take(record.left());
    messages.push_back(message);
  }
  return messages;
}

}  // namespace stagger::server
