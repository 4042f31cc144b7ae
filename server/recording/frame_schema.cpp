#include "server/recording/frame_schema.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "server/json/stream_json.h"
#include "server/recording/bytes.h"
#include "sim/json_file.h"

namespace stagger::server {
namespace {

constexpr double most_components = 4096;

/// A name that message definitions allow: letters, digits and underscores, none of them twice.
class Identifiers {
 public:
  std::string of(const std::string& name) {
    std::string text;
    for (const char c : name) text += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    if (text.empty() || std::isalpha(static_cast<unsigned char>(text.front())) == 0) {
      text.insert(0, "n");
    }
    const std::string first = text;
    for (int i = 2; !used_.insert(text).second; ++i) text = first + "_" + std::to_string(i);
    return text;
  }

 private:
  std::set<std::string> used_;
};

std::string type_of(const std::string& field) {
  std::string type;
  bool upper = true;
  for (const char c : field) {
    if (c == '_') {
      upper = true;
    } else {
      type += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
      upper = false;
    }
  }
  return type;
}

bool is_list(const sim::Channel& channel) { return channel.max_repeat > 1; }

bool is_scalar(const sim::Channel& channel) {
  return !is_list(channel) && channel.components.size() == 1 &&
         channel.components.front().name == "value";
}

void put_values(const sim::Channel& channel, const std::vector<double>& values, std::string& out) {
  if (is_list(channel)) {
    put(out, static_cast<std::uint32_t>(values.size() / channel.components.size()));
  }
  for (const double value : values) put(out, value);
}

std::string about(const sim::Channel& channel) {
  return channel.meaning + (channel.frame.empty() ? "" : "; frame: " + channel.frame);
}

}  // namespace

FrameSchema::FrameSchema(std::vector<sim::Channel> channels) : channels_(std::move(channels)) {
  std::erase_if(channels_, [](const sim::Channel& channel) { return channel.components.empty(); });
}

FrameSchema FrameSchema::parse(const std::string& channels_text) {
  std::vector<sim::Channel> channels;
  sim::JsonErrors errors;
  try {
    sim::read_json(sim::parse_json(channels_text), errors, [&channels](sim::JsonReader& table) {
      table.object_list("channels", sim::Range::between(0, 256), [&](sim::JsonReader& reader) {
        sim::Channel channel;
        channel.name = reader.string("name");
        const nlohmann::json* frame = reader.value("frame");  // may be empty
        if (frame != nullptr && frame->is_string()) channel.frame = frame->get<std::string>();
        channel.meaning = reader.string("meaning", 1024);
        channel.max_repeat =
            static_cast<std::size_t>(reader.integer("max_repeat", sim::Range::between(1, 1024)));
        reader.object_list(
            "components", sim::Range::between(1, most_components),
            [&channel](sim::JsonReader& component) {
              channel.components.push_back({component.string("name"), component.string("unit")});
            });
        channels.push_back(std::move(channel));
      });
    });
  } catch (const sim::JsonSyntaxError& error) {
    errors.add("", error.what());
  }
  if (!errors.empty()) {
    const sim::JsonError& first = errors.list().front();
    throw std::runtime_error("the table of channels: " + first.pointer + " " + first.text);
  }
  return FrameSchema(std::move(channels));
}

std::string FrameSchema::definition() const {
  std::string top =
      "# One tick of the simulation.\n"
      "uint64 tick  # number of the tick since the world's start\n"
      "float64 time  # [s] simulation time at the tick's beginning\n"
      "uint64 state_hash  # over the plant's state after every tick so far\n";
  std::string types;
  Identifiers fields;
  for (const char* taken : {"tick", "time", "state_hash"}) fields.of(taken);
  for (const sim::Channel& channel : channels_) {
    const std::string field = fields.of(channel.name);
    if (is_scalar(channel)) {
      top.append("float64 ").append(field).append("  # [");
      top.append(channel.components.front().unit).append("] ").append(about(channel)).append("\n");
      continue;
    }
    const std::string type = type_of(field);
    top.append("stagger/").append(type).append(is_list(channel) ? "[] " : " ").append(field);
    top.append("  # ").append(about(channel)).append("\n");
    types.append(80, '=').append("\nMSG: stagger/").append(type).append("\n");
    Identifiers components;
    for (const sim::Component& component : channel.components) {
      types.append("float64 ").append(components.of(component.name));
      types.append("  # [").append(component.unit).append("]\n");
    }
  }
  return top + types;
}

std::string FrameSchema::channels_text() const {
  return to_text({{"channels", channels_json(channels_)}});
}

void FrameSchema::write(const FrameMessage& message, std::string& out) const {
  put(out, message.frame.tick);
  put(out, message.frame.time);
  put(out, message.state_hash);
  for (const sim::Channel& channel : channels_) {
    values_.clear();
    channel.read(message.frame, values_);
    if (!is_list(channel)) values_.resize(channel.components.size());
    put_values(channel, values_, out);
  }
}

void FrameSchema::write(const RecordedFrame& frame, std::string& out) const {
  put(out, frame.tick);
  put(out, frame.time);
  put(out, frame.state_hash);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    put_values(channels_[i], frame.values[i], out);
  }
}

RecordedFrame FrameSchema::read(std::string_view data) const {
  ByteReader in(data);
  RecordedFrame frame;
  frame.tick = in.number<std::uint64_t>();
  frame.time = in.number<double>();
  frame.state_hash = in.number<std::uint64_t>();
  for (const sim::Channel& channel : channels_) {
    std::size_t count = channel.components.size();
    if (is_list(channel)) {
      const auto items = in.number<std::uint32_t>();
      if (items > channel.max_repeat) throw BadBytes("a list is longer than its channel allows");
      count *= items;
    }
    std::vector<double>& values = frame.values.emplace_back(count);
    for (double& value : values) value = in.number<double>();
  }
  return frame;
}

}  // namespace stagger::server
