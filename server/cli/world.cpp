#include <iostream>
#include <optional>

#include "server/cli/commands.h"
#include "server/json/gait_json.h"
#include "server/json/parameters_json.h"
#include "server/json/terrain_json.h"
#include "sim/json_file.h"

namespace stagger::server {
namespace {

/// Says what is wrong on standard error; then there is none.
std::optional<sim::TerrainParameters> terrain_of(const std::string& text) {
  sim::JsonErrors errors;
  sim::TerrainParameters terrain;
  try {
    terrain = parse_terrain(text, errors);
  } catch (const sim::JsonSyntaxError& error) {
    std::cerr << "stagger: --terrain is \"" << text << "\": " << error.what() << '\n';
    return std::nullopt;
  }
  for (const sim::JsonError& error : errors.list()) {
    std::cerr << "stagger: --terrain " << error.pointer << ' ' << error.text << '\n';
  }
  if (!errors.empty()) return std::nullopt;
  return terrain;
}

/// False, after a message on standard error, when they cannot be.
bool read_parameters_option(const WorldOptions& options, sim::SimulationConfig& config) {
  bool good = true;
  const auto refuse = [&good](const std::string& why) {
    std::cerr << "stagger: --parameter " << why << '\n';
    good = false;
  };
  for (const std::string& text : options.parameters) {
    if (const auto wrong = parse_parameter(text, config.parameters)) refuse(*wrong);
  }
  if (!good) return false;
  for (const sim::ParameterFault& fault : sim::check_parameters(config, config.parameters)) {
    refuse(fault.name + " " + fault.text);
  }
  return good;
}

}  // namespace

sim::SimulationConfig world_of(const WorldOptions& options, RobotLibrary& robots) {
  sim::SimulationConfig config;
  config.plant = plant_of(options.plant).value_or(sim::PlantKind::bullet);
  config.seed = options.seed;
  config.senses.perfect_state = is_perfect_state(options.state);
  set_control_delay_ms(config.senses, options.control_delay_ms);
  const auto terrain = terrain_of(options.terrain);
  if (!terrain) return config;
  config.terrain = *terrain;
  if (config.plant == sim::PlantKind::lipm && terrain->kind != sim::TerrainKind::flat) {
    std::cerr << "stagger: --terrain is \"" << options.terrain
              << "\"; allowed with --plant lipm: flat\n";
    return config;
  }
  config.robot = robots.find(options.robot);
  if (config.robot == nullptr) {
    std::cerr << "stagger: --robot " << robots.unknown(options.robot) << '\n';
  } else if (!read_parameters_option(options, config)) {
    config.robot = nullptr;
  }
  return config;
}

}  // namespace stagger::server
