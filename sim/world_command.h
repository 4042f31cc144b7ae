// Everything that changes a world while it lives, as a value: what is sent, journalled, recorded
// and replayed.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "engine/parameters.h"
#include "sim/plant/push.h"
#include "sim/simulation.h"

namespace stagger::sim {

struct Walk {
  engine::WalkCommand command;
};

struct StopWalking {};

struct SetStrategies {
  engine::Strategies strategies;  ///< all of them
};

struct FollowSteps {
  std::vector<Footstep> steps;  ///< in the true world
};

struct SetParameters {
  ParameterValues values;  ///< all that are to differ from the robot's own
};

struct StartPush {
  PushSpec spec;
};

struct CancelPush {
  std::uint64_t id = 0;
};

using WorldCommand = std::variant<Walk, StopWalking, SetStrategies, StartPush, CancelPush,
                                  FollowSteps, SetParameters>;

/// Carries the command out: it acts from the next tick on. Throws what the simulation throws
/// (std::invalid_argument), which leaves the world as it was.
void apply(Simulation& world, const WorldCommand& command);

/// A command and the first tick that it acted on. A world's configuration and its entries, each
/// applied before its tick is run, make the same world again to the bit.
struct JournalEntry {
  std::uint64_t tick = 0;
  WorldCommand command;
};

}  // namespace stagger::sim
