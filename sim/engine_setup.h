// The engine's parameters for a robot: from its description, by formula where that can be.
#pragma once

#include "engine/parameters.h"
#include "sim/control/senses.h"
#include "sim/plant/plant.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

engine::Parameters engine_parameters(const Robot& robot, PlantKind plant,
                                     const engine::Strategies& strategies, double tick,
                                     const SenseParameters& senses = {});

}  // namespace stagger::sim
