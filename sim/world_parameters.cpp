#include "sim/world_parameters.h"

#include "sim/engine_setup.h"
#include "sim/parameter_table.h"
#include "sim/simulation.h"

namespace stagger::sim {

WorldParameters default_parameters(const SimulationConfig& config) {
  WorldParameters p;
  p.engine = engine_parameters(*config.robot, config.plant, config.strategies, Simulation::tick_s,
                               config.senses);
  p.gains = whole_body_gains(*config.robot, config.senses.control_delay + Simulation::tick_s);
  p.senses = config.senses;
  p.physics = config.physics;
  p.physics.dt = Simulation::tick_s;
  p.ground_friction = config.terrain.friction;
  p.lipm = lipm_parameters(*config.robot);
  p.lipm.seed = config.seed;
  return p;
}

void set_values(WorldParameters& parameters, const ParameterValues& values) {
  for (const auto& [name, value] : values) {
    if (const ParameterInfo* info = find_parameter(name)) info->set(parameters, value);
  }
}

WorldParameters world_parameters(const SimulationConfig& config, const ParameterValues& values) {
  WorldParameters p = default_parameters(config);
  set_values(p, values);
  return p;
}

}  // namespace stagger::sim
