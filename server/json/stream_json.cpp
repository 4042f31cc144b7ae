#include "server/json/stream_json.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "server/json/gait_json.h"
#include "server/json/json.h"
#include "server/json/terrain_json.h"
#include "sim/json_file.h"
#include "sim/simulation.h"

namespace stagger::server {
namespace {

constexpr double min_rate = 1.0;     // [Hz]
constexpr double max_rate = 1000.0;  // [Hz]: every tick

Json channel_json(const sim::Channel& channel) {
  Json components = Json::array();
  for (const sim::Component& component : channel.components) {
    components.push_back({{"name", component.name}, {"unit", component.unit}});
  }
  return {{"name", channel.name},
          {"frame", channel.frame},
          {"meaning", channel.meaning},
          {"components", std::move(components)},
          {"max_repeat", channel.max_repeat}};
}

// The shortest text that reads back as the same number.
template <typename Number>
void append(std::string& text, Number value) {
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(value)) {
      text += "null";
      return;
    }
  }
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value);
  text.append(digits, end.ptr);
}

}  // namespace

std::string hello_text(const SessionInfo& session) {
  Json channels = Json::array();
  for (const sim::Channel& channel : session.channels) channels.push_back(channel_json(channel));
  Json states = Json::array();
  for (const auto state : {sim::WalkingState::idle, sim::WalkingState::initialize,
                           sim::WalkingState::single_support, sim::WalkingState::double_support}) {
    states.push_back(name_of(state));
  }
  return to_text({{"op", "hello"},
                  {"protocol", 1},
                  {"session_id", session.id},
                  {"robot", session.robot},
                  {"plant", name_of(session.plant)},
                  {"seed", session.seed},
                  {"terrain", terrain_json(session.terrain)},
                  {"tick_s", sim::Simulation::tick_s},
                  {"channels", std::move(channels)},
                  {"states", std::move(states)},
                  {"version", STAGGER_VERSION}});
}

std::string event_text(const EventMessage& event) {
  Json values = Json::object();
  for (const auto& [name, value] : event.values) values[name] = value;
  Json json{{"op", "event"},      {"tick", event.tick}, {"t", event.time},
            {"kind", event.kind}, {"text", event.text}, {"values", std::move(values)}};
  if (!event.source.empty()) json["source"] = event.source;
  return to_text(json);
}

std::string error_text(const std::string& detail) {
  return to_text({{"op", "error"}, {"detail", detail}});
}

std::string heartbeat_text(std::uint64_t tick, double time, bool running, std::uint64_t dropped) {
  return to_text({{"op", "heartbeat"},
                  {"tick", tick},
                  {"t", time},
                  {"running", running},
                  {"dropped", dropped}});
}

std::string subscribed_text(const Subscription& subscription, const SessionInfo& session) {
  Json channels = Json::array();
  if (subscription.channels) {
    for (const std::string& name : *subscription.channels) channels.push_back(name);
  } else {
    for (const sim::Channel& channel : session.channels) channels.push_back(channel.name);
  }
  return to_text({{"op", "subscribed"},
                  {"rate_hz", subscription.rate_hz},
                  {"channels", std::move(channels)},
                  {"events", subscription.events}});
}

Subscription read_subscription(const std::string& text, const SessionInfo& session,
                               sim::JsonErrors& errors) {
  Subscription subscription;
  try {
    sim::read_json(sim::parse_json(text), errors, [&](sim::JsonReader& reader) {
      reader.one_of<bool>("op", {{"subscribe", true}});
      subscription.rate_hz = reader.number_or("rate_hz", subscription.rate_hz,
                                              sim::Range::between(min_rate, max_rate, "Hz"));
      if (reader.has("channels")) {
        subscription.channels = reader.string_list("channels", sim::Range::between(0, 256));
        for (const std::string& name : *subscription.channels) {
          if (sim::find_channel(session.channels, name) == nullptr) {
            reader.refuse("channels", "names \"" + name + "\", which is no channel; see hello");
          }
        }
      }
      subscription.events = reader.boolean_or("events", true);
    });
  } catch (const sim::JsonSyntaxError& error) {
    errors.add("", std::string("not JSON: ") + error.what());
  }
  return subscription;
}

const std::string& DataWriter::text(const FrameMessage& message,
                                    const SubscriptionPtr& subscription, std::uint64_t seq) {
  if (session_ != message.session || subscription_ != subscription) {
    session_ = message.session;
    subscription_ = subscription;
    channels_.clear();
    for (const sim::Channel& channel : session_->channels) {
      const auto& wanted = subscription_->channels;
      if (!wanted || std::find(wanted->begin(), wanted->end(), channel.name) != wanted->end()) {
        channels_.push_back(&channel);
      }
    }
  }
  text_ = R"({"op":"data","seq":)";
  append(text_, seq);
  text_ += R"(,"tick":)";
  append(text_, message.frame.tick);
  text_ += R"(,"t":)";
  append(text_, message.frame.time);
  text_ += R"(,"v":{)";
  for (const sim::Channel* channel : channels_) {
    if (channel != channels_.front()) text_ += ',';
    text_ += '"' + channel->name + R"(":[)";
    values_.clear();
    channel->read(message.frame, values_);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if (i > 0) text_ += ',';
      append(text_, values_[i]);
    }
    text_ += ']';
  }
  text_ += "}}";
  return text_;
}

}  // namespace stagger::server
