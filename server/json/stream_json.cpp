#include "server/json/stream_json.h"

#include <algorithm>
#include <set>

#include "server/json/gait_json.h"
#include "server/json/json.h"
#include "server/json/stream_data.h"
#include "server/json/terrain_json.h"
#include "sim/json_file.h"
#include "sim/simulation.h"

namespace stagger::server {
namespace {

constexpr double min_rate = 1.0;     // [Hz]
constexpr double max_rate = 1000.0;  // [Hz]: every tick

sim::Range rate_range() { return sim::Range::between(min_rate, max_rate, "Hz"); }

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

const sim::Names<StreamFormat> formats{{"json", StreamFormat::json},
                                       {"float64", StreamFormat::float64},
                                       {"float32", StreamFormat::float32}};

std::string_view format_name(StreamFormat format) {
  return formats[static_cast<std::size_t>(format)].first;
}

/// Index of the rate among those of the subscription, which it is added to when it is new.
std::size_t rate_index(std::vector<double>& rates, double rate_hz) {
  const auto found = std::find(rates.begin(), rates.end(), rate_hz);
  const auto index = static_cast<std::size_t>(found - rates.begin());
  if (found == rates.end()) rates.push_back(rate_hz);
  return index;
}

void check_fields(sim::JsonReader& reader, const sim::Channel& channel,
                  const ChannelChoice& choice) {
  for (std::size_t i = 0; i < choice.fields.size(); ++i) {
    const std::string& field = choice.fields[i];
    const auto& known = channel.components;
    if (std::none_of(known.begin(), known.end(), [&](const auto& c) { return c.name == field; })) {
      reader.refuse("fields", "names \"" + field + "\", which is no component of the channel \"" +
                                  channel.name + "\"; see hello");
    } else if (std::find(choice.fields.begin(), choice.fields.begin() + static_cast<long>(i),
                         field) != choice.fields.begin() + static_cast<long>(i)) {
      reader.refuse("fields", "names \"" + field + "\" twice");
    }
  }
}

const auto channel_count = sim::Range::between(0, 256);

/// `channels` as a list of names, which all come at the one rate.
std::vector<ChannelChoice> read_names(sim::JsonReader& reader) {
  std::vector<ChannelChoice> choices;
  for (std::string& name : reader.string_list("channels", channel_count)) {
    choices.push_back({std::move(name), 0, {}});
  }
  return choices;
}

/// `channels` as a list of objects, each with a rate and fields of its own.
std::vector<ChannelChoice> read_choices(sim::JsonReader& reader, const SessionInfo& session,
                                        double rate_hz, std::vector<double>& rates) {
  std::vector<ChannelChoice> choices;
  rates.clear();
  reader.object_list("channels", channel_count, [&](sim::JsonReader& item) {
    ChannelChoice choice;
    choice.name = item.string("name");
    choice.rate = rate_index(rates, item.number_or("rate_hz", rate_hz, rate_range()));
    if (item.has("fields")) {
      choice.fields = item.string_list("fields", sim::Range::between(1, sim::max_joints));
    }
    const sim::Channel* channel = sim::find_channel(session.channels, choice.name);
    if (channel != nullptr) check_fields(item, *channel, choice);
    choices.push_back(std::move(choice));
  });
  if (rates.empty()) rates.push_back(rate_hz);
  if (rates.size() > Subscription::max_rates) {
    reader.refuse("channels", "ask for " + std::to_string(rates.size()) +
                                  " different rates; allowed: at most " +
                                  std::to_string(Subscription::max_rates));
  }
  return choices;
}

void check_channels(sim::JsonReader& reader, const SessionInfo& session,
                    const std::vector<ChannelChoice>& choices) {
  std::set<std::string> seen;
  for (const ChannelChoice& choice : choices) {
    if (sim::find_channel(session.channels, choice.name) == nullptr) {
      reader.refuse("channels", "names \"" + choice.name + "\", which is no channel; see hello");
    } else if (!seen.insert(choice.name).second) {
      reader.refuse("channels", "names \"" + choice.name + "\" twice");
    }
  }
}

Json layout_json(const ChannelLayout& layout) {
  Json channels = Json::array();
  for (const ChannelPick& pick : layout) {
    Json fields = Json::array();
    for (const std::size_t i : pick.fields) fields.push_back(pick.channel->components[i].name);
    channels.push_back({{"name", pick.channel->name},
                        {"rate", pick.rate},
                        {"fields", std::move(fields)},
                        {"max_repeat", pick.channel->max_repeat}});
  }
  return channels;
}

}  // namespace

Json channels_json(const std::vector<sim::Channel>& channels) {
  Json json = Json::array();
  for (const sim::Channel& channel : channels) json.push_back(channel_json(channel));
  return json;
}

std::string hello_text(const SessionInfo& session) {
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
                  {"channels", channels_json(session.channels)},
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
  const ChannelLayout layout = layout_of(subscription, session);
  Json channels = Json::array();
  for (const ChannelPick& pick : layout) channels.push_back(pick.channel->name);
  return to_text({{"op", "subscribed"},
                  {"rate_hz", subscription.rates.front()},
                  {"channels", std::move(channels)},
                  {"events", subscription.events},
                  {"format", format_name(subscription.format)},
                  {"rates_hz", subscription.rates},
                  {"layout", layout_json(layout)}});
}

Subscription read_subscription(const std::string& text, const SessionInfo& session,
                               sim::JsonErrors& errors) {
  Subscription subscription;
  try {
    sim::read_json(sim::parse_json(text), errors, [&](sim::JsonReader& reader) {
      reader.one_of<bool>("op", {{"subscribe", true}});
      const double rate_hz = reader.number_or("rate_hz", 60.0, rate_range());
      subscription.rates = {rate_hz};
      if (reader.has("channels")) {
        const nlohmann::json* list = reader.value("channels");
        const bool objects = list->is_array() && !list->empty() && list->front().is_object();
        subscription.channels = objects ? read_choices(reader, session, rate_hz, subscription.rates)
                                        : read_names(reader);
        check_channels(reader, session, *subscription.channels);
      }
      subscription.format = reader.one_of_or("format", StreamFormat::json, formats);
      subscription.events = reader.boolean_or("events", true);
    });
  } catch (const sim::JsonSyntaxError& error) {
    errors.add("", std::string("not JSON: ") + error.what());
  }
  return subscription;
}

}  // namespace stagger::server
