// Every number that a world is built with, in one place: from the robot, then as somebody wants it.
#pragma once

#include <map>
#include <string>

#include "engine/parameters.h"
#include "sim/control/senses.h"
#include "sim/control/whole_body_gains.h"
#include "sim/plant/bullet_world.h"
#include "sim/plant/lipm_plant.h"
#include "sim/plant/terrain.h"

namespace stagger::sim {

struct SimulationConfig;

/// Parameters by name (parameter_table.h) that are to differ from the robot's own. Flags are 0 or
/// 1.
using ParameterValues = std::map<std::string, double, std::less<>>;

struct WorldParameters {
  engine::Parameters engine;
  WholeBodyGains gains;        ///< of the full body
  SenseParameters senses;      ///< of the full body
  PhysicsParameters physics;   ///< of the full body
  double ground_friction = 0;  ///< Coulomb coefficient of the terrain, but for its patches
  LipmParameters lipm;         ///< of the pendulum
};

/// What the robot and the rest of the configuration give, whatever config.parameters asks for.
WorldParameters default_parameters(const SimulationConfig& config);

/// Puts values in the place of what is there. Names that are not known are left out.
void set_values(WorldParameters& parameters, const ParameterValues& values);

/// The default parameters with these values set.
WorldParameters world_parameters(const SimulationConfig& config, const ParameterValues& values);

}  // namespace stagger::sim
