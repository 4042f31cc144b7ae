#include "server/recording/mcap_writer.h"

#include <algorithm>
#include <utility>

#include "server/recording/bytes.h"

namespace stagger::server {
namespace {

std::string record(McapOp op, const std::string& content) {
  std::string bytes;
  bytes.reserve(9 + content.size());
  put(bytes, static_cast<std::uint8_t>(op));
  put(bytes, static_cast<std::uint64_t>(content.size()));
  return bytes += content;
}

std::string map_bytes(const std::map<std::string, std::string>& values) {
  std::string entries;
  for (const auto& [key, value] : values) {
    put_text(entries, key);
    put_text(entries, value);
  }
  return entries;
}

std::string map_bytes(const std::map<std::uint16_t, std::uint64_t>& values) {
  std::string entries;
  for (const auto& [key, value] : values) {
    put(entries, key);
    put(entries, value);
  }
  return entries;
}

std::string schema_record(const McapSchema& schema) {
  std::string content;
  put(content, schema.id);
  put_text(content, schema.name);
  put_text(content, schema.encoding);
  put_text(content, schema.data);
  return record(McapOp::schema, content);
}

std::string channel_record(const McapChannel& channel) {
  std::string content;
  put(content, channel.id);
  put(content, channel.schema);
  put_text(content, channel.topic);
  put_text(content, channel.encoding);
  put_text(content, map_bytes(channel.metadata));
  return record(McapOp::channel, content);
}

std::string statistics_record(const McapIndex& index) {
  std::uint64_t messages = 0;
  for (const auto& [channel, count] : index.message_counts) messages += count;
  std::uint64_t start = index.chunks.empty() ? 0 : index.chunks.front().start_time;
  std::uint64_t end = 0;
  for (const McapChunkPlace& chunk : index.chunks) {
    start = std::min(start, chunk.start_time);
    end = std::max(end, chunk.end_time);
  }
  std::string content;
  put(content, messages);
  put(content, static_cast<std::uint16_t>(index.schemas.size()));
  put(content, static_cast<std::uint32_t>(index.channels.size()));
  put(content, std::uint32_t{0});  // attachments
  put(content, static_cast<std::uint32_t>(index.metadata.size()));
  put(content, static_cast<std::uint32_t>(index.chunks.size()));
  put(content, start);
  put(content, end);
  put_text(content, map_bytes(index.message_counts));
  return record(McapOp::statistics, content);
}

std::string chunk_index_record(const McapChunkPlace& chunk) {
  std::string content;
  put(content, chunk.start_time);
  put(content, chunk.end_time);
  put(content, chunk.offset);
  put(content, chunk.length);
  put_text(content, map_bytes(chunk.message_indexes));
  put(content, chunk.message_index_length);
  put_text(content, chunk.compression);
  put(content, chunk.compressed_size);
  put(content, chunk.plain_size);
  return record(McapOp::chunk_index, content);
}

std::string metadata_index_record(const McapMetadataPlace& place) {
  std::string content;
  put(content, place.offset);
  put(content, place.length);
  put_text(content, place.name);
  return record(McapOp::metadata_index, content);
}

/// A group of the summary's records of one kind, and where it is.
class Summary {
 public:
  explicit Summary(std::uint64_t start) : start_(start) {}

  void begin() { group_ = bytes_.size(); }
  void add(const std::string& text) { bytes_ += text; }
  void end(McapOp op) {
    if (bytes_.size() == group_) return;
    std::string content;
    put(content, static_cast<std::uint8_t>(op));
    put(content, start_ + group_);
    put(content, static_cast<std::uint64_t>(bytes_.size() - group_));
    offsets_ += record(McapOp::summary_offset, content);
  }

  /// The whole, with the footer and the magic.
  std::string finished() {
    const std::uint64_t offset_start = start_ + bytes_.size();
    bytes_ += offsets_;
    put(bytes_, static_cast<std::uint8_t>(McapOp::footer));
    put(bytes_, std::uint64_t{8 + 8 + 4});
    put(bytes_, start_);
    put(bytes_, offset_start);
    put(bytes_, crc_over(0, bytes_));
    return bytes_ += mcap_magic;
  }

 private:
  std::uint64_t start_;
  std::size_t group_ = 0;
  std::string bytes_;
  std::string offsets_;
};

}  // namespace

McapWriter::McapWriter(Sink sink) : sink_(std::move(sink)) {
  std::string content;
  put_text(content, "");  // no profile
  put_text(content, "stagger " STAGGER_VERSION);
  append(std::string(mcap_magic) + record(McapOp::header, content));
}

void McapWriter::append(std::string_view bytes) {
  sink_(bytes);
  index_.data_crc = crc_over(index_.data_crc, bytes);
  index_.size += bytes.size();
}

void McapWriter::add(const McapSchema& schema) {
  append(schema_record(schema));
  index_.schemas[schema.id] = schema;
}

void McapWriter::add(const McapChannel& channel) {
  append(channel_record(channel));
  index_.channels[channel.id] = channel;
}

void McapWriter::add_metadata(const std::string& name,
                              const std::map<std::string, std::string>& values) {
  std::string content;
  put_text(content, name);
  put_text(content, map_bytes(values));
  const std::string bytes = record(McapOp::metadata, content);
  McapMetadataPlace place{index_.size, bytes.size(), name};
  append(bytes);
  index_.metadata.push_back(std::move(place));
}

void McapWriter::add(const McapChunk& chunk) {
  std::string content;
  content.reserve(chunk.bytes.size() + 64);
  put(content, chunk.start_time);
  put(content, chunk.end_time);
  put(content, chunk.plain_size);
  put(content, chunk.plain_crc);
  put_text(content, chunk.compression);
  put(content, static_cast<std::uint64_t>(chunk.bytes.size()));
  content += chunk.bytes;
  std::string bytes = record(McapOp::chunk, content);

  McapChunkPlace place{chunk.start_time,  chunk.end_time,     index_.size,     bytes.size(), {}, 0,
                       chunk.compression, chunk.bytes.size(), chunk.plain_size};
  for (const auto& [channel, messages] : chunk.places) {
    place.message_indexes[channel] = index_.size + bytes.size();
    std::string entries;
    entries.reserve(16 * messages.size());
    for (const auto& [time, offset] : messages) {
      put(entries, time);
      put(entries, offset);
    }
    std::string index;
    put(index, channel);
    put_text(index, entries);
    bytes += record(McapOp::message_index, index);
  }
  place.message_index_length = bytes.size() - place.length;
  append(bytes);
  index_.chunks.push_back(std::move(place));
  for (const auto& [channel, messages] : chunk.places) {
    index_.message_counts[channel] += messages.size();
  }
}

void McapWriter::finish() {
  std::string end;
  put(end, index_.data_crc);
  const std::string data_end = record(McapOp::data_end, end);
  Summary summary(index_.size + data_end.size());
  summary.begin();
  for (const auto& [id, schema] : index_.schemas) summary.add(schema_record(schema));
  summary.end(McapOp::schema);
  summary.begin();
  for (const auto& [id, channel] : index_.channels) summary.add(channel_record(channel));
  summary.end(McapOp::channel);
  summary.begin();
  summary.add(statistics_record(index_));
  summary.end(McapOp::statistics);
  summary.begin();
  for (const McapChunkPlace& chunk : index_.chunks) summary.add(chunk_index_record(chunk));
  summary.end(McapOp::chunk_index);
  summary.begin();
  for (const McapMetadataPlace& place : index_.metadata) summary.add(metadata_index_record(place));
  summary.end(McapOp::metadata_index);
  append(data_end + summary.finished());
}

}  // namespace stagger::server
