#include "server/recording/mcap_reader.h"

#include <array>
#include <stdexcept>

#include "server/recording/bytes.h"
#include "server/recording/mcap_chunk.h"
#include "server/recording/mcap_file.h"
#include "server/recording/mcap_writer.h"

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_record_bytes = 256ULL << 20;
constexpr std::uint64_t record_head = 1 + 8;

/// Of the first `size` bytes.
std::uint32_t crc_of_start(const fs::path& file, std::uint64_t size) {
  std::ifstream in(file, std::ios::binary);
  std::uint32_t crc = 0;
  std::string part(1 << 20, '\0');
  while (size > 0) {
    const auto want = static_cast<std::streamsize>(std::min<std::uint64_t>(size, part.size()));
    in.read(part.data(), want);
    if (in.gcount() != want) throw std::runtime_error(file.string() + " cannot be read");
    crc = crc_over(crc, std::string_view(part).substr(0, static_cast<std::size_t>(want)));
    size -= static_cast<std::uint64_t>(want);
  }
  return crc;
}

/// What a scan finds: all that is whole, and a last chunk whose index was cut off.
struct Scan {
  McapIndex index;
  std::optional<McapChunk> last;
};

McapChunk chunk_of(const McapChunkView& view) {
  McapChunk chunk{view.start_time,
                  view.end_time,
                  view.plain_size,
                  view.plain_crc,
                  std::string(view.compression),
                  std::string(view.bytes),
                  {}};
  const std::string plain = unpack(view);
  for (const McapMessage& message : messages_of(plain)) {
    chunk.places[message.channel].emplace_back(message.time, message.place);
  }
  return chunk;
}

void note_message_index(const McapRecord& record, McapIndex& index) {
  ByteReader in(record.content);
  const auto channel = in.number<std::uint16_t>();
  const std::uint64_t messages = in.text().size() / 16;
  if (index.chunks.empty()) throw BadBytes("an index without a chunk");
  McapChunkPlace& chunk = index.chunks.back();
  chunk.message_indexes[channel] = record.offset;
  chunk.message_index_length += record_head + record.content.size();
  index.message_counts[channel] += messages;
}

void note_chunk(const McapRecord& record, McapIndex& index) {
  const McapChunkView view = view_chunk(record.content);
  index.chunks.push_back({view.start_time,
                          view.end_time,
                          record.offset,
                          record_head + record.content.size(),
                          {},
                          0,
                          std::string(view.compression),
                          view.bytes.size(),
                          view.plain_size});
}

/// Notes what is in the file up to where it was cut. The last chunk's own messages are counted from
/// the chunk itself: its indexes may be missing.
Scan scan(const fs::path& file) {
  McapReader reader(file);
  Scan found;
  McapIndex before_last;  // as it was before the last chunk
  std::string last_chunk;
  while (auto record = reader.next()) {
    try {
      switch (record->op) {
        case McapOp::schema: {
          McapSchema schema = read_schema(record->content);
          found.index.schemas[schema.id] = std::move(schema);
          break;
        }
        case McapOp::channel: {
          McapChannel channel = read_channel(record->content);
          found.index.channels[channel.id] = std::move(channel);
          break;
        }
        case McapOp::metadata:
          found.index.metadata.push_back({record->offset, record_head + record->content.size(),
                                          read_metadata(record->content).first});
          break;
        case McapOp::chunk: {
          found.index.size = record->offset;
          before_last = found.index;
          last_chunk = record->content;
          note_chunk(*record, found.index);
          break;
        }
        case McapOp::message_index:
          note_message_index(*record, found.index);
          break;
        default:
          break;
      }
    } catch (const BadBytes&) {
      break;
    }
    found.index.size = reader.offset();
    // A chunk is the last one only if nothing but its indexes comes behind it.
    if (record->op != McapOp::chunk && record->op != McapOp::message_index) last_chunk.clear();
  }
  if (!last_chunk.empty()) {
    found.index = std::move(before_last);
    try {
      found.last = chunk_of(view_chunk(last_chunk));
    } catch (const BadBytes&) {
      // It is not whole: the file ends before it.
    }
  }
  found.index.data_crc = crc_of_start(file, found.index.size);
  return found;
}

}  // namespace

McapReader::McapReader(const fs::path& file) : in_(file, std::ios::binary) {
  std::error_code error;
  size_ = fs::file_size(file, error);
  std::array<char, mcap_magic.size()> magic{};
  if (error || !in_.read(magic.data(), magic.size())) {
    throw std::runtime_error(file.string() + " cannot be read, or is empty");
  }
  if (std::string_view(magic.data(), magic.size()) != mcap_magic) {
    throw std::runtime_error(file.string() + " is no MCAP file");
  }
  offset_ = magic.size();
}

std::optional<McapRecord> McapReader::next(bool with_chunks) {
  std::array<char, record_head> head{};
  if (complete_ || size_ - offset_ < head.size()) return std::nullopt;
  if (!in_.read(head.data(), head.size())) return std::nullopt;
  ByteReader fields({head.data(), head.size()});
  McapRecord record;
  record.op = static_cast<McapOp>(fields.number<std::uint8_t>());
  const auto length = fields.number<std::uint64_t>();
  if (length > most_record_bytes || length > size_ - offset_ - head.size()) return std::nullopt;
  if (record.op == McapOp::data_end || record.op == McapOp::footer) {
    complete_ = true;
    return std::nullopt;
  }
  record.offset = offset_;
  if (!with_chunks && (record.op == McapOp::chunk || record.op == McapOp::message_index)) {
    if (!in_.seekg(static_cast<std::streamoff>(length), std::ios::cur)) return std::nullopt;
  } else {
    record.content.resize(length);
    if (!in_.read(record.content.data(), static_cast<std::streamsize>(length))) return std::nullopt;
  }
  offset_ += head.size() + length;
  return record;
}

McapSchema read_schema(std::string_view content) {
  ByteReader in(content);
  McapSchema schema;
  schema.id = in.number<std::uint16_t>();
  schema.name = in.text();
  schema.encoding = in.text();
  schema.data = in.text();
  return schema;
}

McapChannel read_channel(std::string_view content) {
  ByteReader in(content);
  McapChannel channel;
  channel.id = in.number<std::uint16_t>();
  channel.schema = in.number<std::uint16_t>();
  channel.topic = in.text();
  channel.encoding = in.text();
  channel.metadata = in.text_map();
  return channel;
}

std::pair<std::string, std::map<std::string, std::string>> read_metadata(std::string_view content) {
  ByteReader in(content);
  std::string name(in.text());
  return {std::move(name), in.text_map()};
}

bool is_finished(const fs::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  std::array<char, mcap_magic.size()> end{};
  const std::streamoff size = in.tellg();
  if (!in || size < 2 * static_cast<std::streamoff>(end.size())) return false;
  in.seekg(size - static_cast<std::streamoff>(end.size()));
  return in.read(end.data(), end.size()) && std::string_view(end.data(), end.size()) == mcap_magic;
}

void repair_mcap(const fs::path& file) {
  // Before it is looked at: what another process writes is not to be cut.
  McapFile out(file, McapFile::Open::change);
  Scan found = scan(file);
  out.cut(found.index.size);
  McapWriter writer([&out](std::string_view bytes) { out.write(bytes); }, std::move(found.index));
  if (found.last) writer.add(*found.last);
  writer.finish();
  out.finish();
}

}  // namespace stagger::server
