#include <iostream>
#include <optional>

#include "server/cli/commands.h"
#include "server/json/gait_json.h"
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
  }
  return config;
}

}  // namespace stagger::server
