// A world's configuration and what changes it, as recordings keep them.
#pragma once

#include <optional>
#include <string>

#include "server/json/json.h"
#include "sim/simulation.h"
#include "sim/strict_json.h"
#include "sim/world_command.h"

namespace stagger::server {

/// All that a world is built from, its robot by name.
Json world_json(const sim::SimulationConfig& config);

/// The configuration, its robot left out, and the robot's name.
struct WorldSpec {
  std::string robot;
  sim::SimulationConfig config;
};
WorldSpec read_world(sim::JsonReader& reader);

/// {"walk":{…}}, {"stop":{}}, {"strategies":{…}}, {"steps":[…]}, {"parameters":{…}}, {"push":{…}}
/// or
/// {"cancel_push":{"id":7}}.
Json command_json(const sim::WorldCommand& command);
/// Nothing, and an error, when it is none of them.
std::optional<sim::WorldCommand> read_command(sim::JsonReader& reader);

}  // namespace stagger::server
