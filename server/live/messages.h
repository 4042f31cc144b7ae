// What the simulation thread hands to everyone who listens. Made once, shared, never changed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/live/journal.h"
#include "sim/channels.h"
#include "sim/frame.h"
#include "sim/plant/plant.h"
#include "sim/plant/terrain.h"
#include "sim/simulation.h"

namespace stagger::server {

/// One life of a world, from its making to the next reset.
struct SessionInfo {
  std::string id;  ///< random, so that a client that missed the reset still sees it
  std::string robot;
  sim::PlantKind plant = sim::PlantKind::bullet;
  std::uint64_t seed = 1;
  sim::TerrainParameters terrain;
  std::vector<sim::Channel> channels;
  sim::SimulationConfig config;      ///< as the world began; with the journal it makes it again
  std::shared_ptr<Journal> journal;  ///< goes on being written
};

using SessionPtr = std::shared_ptr<const SessionInfo>;

struct FrameMessage {
  SessionPtr session;
  sim::Frame frame;
  std::uint64_t state_hash = 0;  ///< after the frame's tick
};

using FramePtr = std::shared_ptr<const FrameMessage>;

struct EventMessage {
  std::uint64_t tick = 0;
  double time = 0.0;
  std::string kind;
  std::string text;
  std::vector<std::pair<std::string, double>> values;
  std::string source;  ///< of commands: who sent it
};

using EventPtr = std::shared_ptr<const EventMessage>;

/// How frames are written for a client: text, or binary with numbers of 8 or 4 bytes.
enum class StreamFormat : std::uint8_t { json, float64, float32 };

/// A channel that a client wants.
struct ChannelChoice {
  std::string name;
  std::size_t rate = 0;             ///< index in the subscription's rates
  std::vector<std::string> fields;  ///< names of components; all when empty
};

/// What one client wants to be told.
struct Subscription {
  static constexpr std::size_t max_rates = 16;

  std::vector<double> rates{60.0};                     ///< [Hz] in simulation time, 1..max_rates
  std::optional<std::vector<ChannelChoice>> channels;  ///< all at the first rate when missing
  bool events = true;
  StreamFormat format = StreamFormat::json;
};

/// Bit i: what comes at rate i of the subscription.
using RateMask = std::uint16_t;

using SubscriptionPtr = std::shared_ptr<const Subscription>;

}  // namespace stagger::server
