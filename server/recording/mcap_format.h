// The records of MCAP version 0 that recordings use, and what a file's summary is made from.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace stagger::server {

inline constexpr double ns_per_s = 1e9;  // times are in ns

inline constexpr std::string_view mcap_magic{"\x89MCAP0\r\n", 8};

enum class McapOp : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0b,
  metadata = 0x0c,
  metadata_index = 0x0d,
  summary_offset = 0x0e,
  data_end = 0x0f
};

struct McapSchema {
  std::uint16_t id = 0;
  std::string name;
  std::string encoding;
  std::string data;
};

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;
  std::string topic;
  std::string encoding;
  std::map<std::string, std::string> metadata;
};

/// Where the messages of one channel are in a chunk: log time [ns] and place in its plain bytes.
using McapMessagePlaces = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

/// A finished chunk: its record's content but for where it goes.
struct McapChunk {
  std::uint64_t start_time = 0;  ///< of the first message [ns]
  std::uint64_t end_time = 0;    ///< of the last one [ns]
  std::uint64_t plain_size = 0;
  std::uint32_t plain_crc = 0;
  std::string compression;  ///< "zstd", or "" for none
  std::string bytes;        ///< compressed
  std::map<std::uint16_t, McapMessagePlaces> places;
};

struct McapChunkPlace {
  std::uint64_t start_time = 0;
  std::uint64_t end_time = 0;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  ///< of the chunk's record
  std::map<std::uint16_t, std::uint64_t> message_indexes;
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t plain_size = 0;
};

struct McapMetadataPlace {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string name;
};

/// All that the summary at the end of a file tells of what comes before it.
struct McapIndex {
  std::uint64_t size = 0;      ///< of the data section so far, magic included
  std::uint32_t data_crc = 0;  ///< of these bytes
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
  std::vector<McapChunkPlace> chunks;
  std::vector<McapMetadataPlace> metadata;
  std::map<std::uint16_t, std::uint64_t> message_counts;
};

}  // namespace stagger::server
