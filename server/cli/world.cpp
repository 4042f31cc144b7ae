#include <iostream>

#include "server/cli/commands.h"
#include "server/json/gait_json.h"

namespace stagger::server {

sim::SimulationConfig world_of(const WorldOptions& options, RobotLibrary& robots) {
  sim::SimulationConfig config;
  config.robot = robots.find(options.robot);
  if (config.robot == nullptr) {
    std::cerr << "stagger: --robot " << robots.unknown(options.robot) << '\n';
  }
  config.plant = plant_of(options.plant).value_or(sim::PlantKind::bullet);
  config.seed = options.seed;
  config.senses.perfect_state = is_perfect_state(options.state);
  set_control_delay_ms(config.senses, options.control_delay_ms);
  return config;
}

}  // namespace stagger::server
