// What the simulation thread hands to everyone who listens. Made once, shared, never changed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/channels.h"
#include "sim/frame.h"
#include "sim/plant/plant.h"
#include "sim/plant/terrain.h"

namespace stagger::server {

/// One life of a world, from its making to the next reset.
struct SessionInfo {
  std::string id;  ///< random, so that a client that missed the reset still sees it
  std::string robot;
  sim::PlantKind plant = sim::PlantKind::bullet;
  std::uint64_t seed = 1;
  sim::TerrainParameters terrain;
  std::vector<sim::Channel> channels;
};

using SessionPtr = std::shared_ptr<const SessionInfo>;

struct FrameMessage {
  SessionPtr session;
  sim::Frame frame;
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

/// What one client wants to be told.
struct Subscription {
  double rate_hz = 60.0;                             ///< in simulation time
  std::optional<std::vector<std::string>> channels;  ///< all when empty
  bool events = true;
};

using SubscriptionPtr = std::shared_ptr<const Subscription>;

}  // namespace stagger::server
