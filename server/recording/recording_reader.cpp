#include "server/recording/recording_reader.h"

#include <charconv>

#include "server/recording/bytes.h"
#include "sim/json_file.h"

namespace stagger::server {
namespace {

std::string field(const std::map<std::string, std::string>& values, const char* name) {
  const auto found = values.find(name);
  return found == values.end() ? "" : found->second;
}

std::uint64_t number(const std::string& text) {
  std::uint64_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// Reads JSON that this program has written.
template <typename Fields>
void read_own(const std::string& text, const char* what, const Fields& fields) {
  sim::JsonErrors errors;
  try {
    sim::read_json(sim::parse_json(text), errors, fields);
  } catch (const sim::JsonSyntaxError& error) {
    errors.add("", error.what());
  }
  if (!errors.empty()) {
    const sim::JsonError& first = errors.list().front();
    throw std::runtime_error(std::string(what) + ": " + first.pointer + " " + first.text);
  }
}

}  // namespace

RecordingReader::RecordingReader(const std::filesystem::path& file) : reader_(file) {
  // The file's own metadata comes before anything else of interest.
  while (about_.empty()) {
    const auto record = reader_.next();
    if (!record || record->op == McapOp::chunk) {
      throw std::runtime_error(file.string() + " is no recording of stagger");
    }
    try {
      take(*record);
    } catch (const BadBytes& error) {
      throw std::runtime_error(file.string() + ": " + error.what());
    }
  }
}

std::optional<RecordedItem> RecordingReader::next() {
  try {
    for (;;) {
      if (auto item = from_chunk()) return item;
      const auto record = reader_.next();
      if (!record) return std::nullopt;
      if (auto item = take(*record)) return item;
    }
  } catch (const BadBytes&) {
    return std::nullopt;
  }
}

std::optional<RecordedItem> RecordingReader::from_chunk() {
  while (at_ < messages_.size()) {
    const McapMessage& message = messages_[at_++];
    const auto channel = channels_.find(message.channel);
    if (channel == channels_.end()) continue;
    if (channel->second.topic == frame_topic) {
      if (message.time < from_ns_) continue;
      const auto& schema = schemas_[message.channel];
      if (schema == nullptr) continue;
      return RecordedTick{message.time, message.channel, schema, schema->read(message.data)};
    }
    const bool is_command = channel->second.topic == command_topic;
    if (!is_command && (channel->second.topic != event_topic || message.time < from_ns_)) continue;
    return RecordedText{message.time, is_command, std::string(message.data)};
  }
  return std::nullopt;
}

std::optional<RecordedItem> RecordingReader::take(const McapRecord& record) {
  if (record.op == McapOp::channel) {
    McapChannel channel = read_channel(record.content);
    if (channel.topic == frame_topic) {
      try {
        schemas_[channel.id] = std::make_shared<const FrameSchema>(
            FrameSchema::parse(field(channel.metadata, "channels")));
      } catch (const std::runtime_error& error) {
        throw BadBytes(error.what());
      }
    }
    channels_[channel.id] = std::move(channel);
  } else if (record.op == McapOp::metadata) {
    auto [name, values] = read_metadata(record.content);
    if (name == recording_metadata) {
      about_ = std::move(values);
    } else if (name == world_metadata) {
      return RecordedWorld{worlds_++,
                           field(values, "session_id"),
                           field(values, "world"),
                           field(values, "robot_files"),
                           field(values, "version"),
                           field(values, "journal") != "cut",
                           number(field(values, "epoch_ns"))};
    }
  } else if (record.op == McapOp::chunk) {
    plain_ = unpack(view_chunk(record.content));
    messages_ = messages_of(plain_);
    at_ = 0;
  }
  return std::nullopt;
}

std::map<std::string, std::string> metadata_of(const RecordedWorld& world) {
  return {{"session_id", world.session_id},
          {"world", world.text},
          {"robot_files", world.robot_files},
          {"journal", world.journal_is_whole ? "whole" : "cut"},
          {"epoch_ns", std::to_string(world.epoch_ns)},
          {"version", world.version}};
}

bool cuts_journal(const RecordedText& text) {
  return !text.is_command &&
         text.text.find(std::string("\"kind\":\"") + cut_journal_kind + '"') != std::string::npos;
}

WorldSpec world_of(const RecordedWorld& world) {
  WorldSpec spec;
  read_own(world.text, "the world's configuration",
           [&spec](sim::JsonReader& reader) { spec = read_world(reader); });
  return spec;
}

sim::JournalEntry entry_of(const RecordedText& text) {
  sim::JournalEntry entry;
  read_own(text.text, "a command", [&entry](sim::JsonReader& reader) {
    entry.tick = static_cast<std::uint64_t>(reader.integer("tick", sim::Range::between(0, 9e15)));
    reader.object("command", [&entry](sim::JsonReader& command) {
      if (auto known = read_command(command)) entry.command = std::move(*known);
    });
  });
  return entry;
}

}  // namespace stagger::server
