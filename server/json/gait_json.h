// Walk commands, strategies and plants: the words that requests, trials and answers share.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "engine/parameters.h"
#include "server/json/json.h"
#include "sim/frame.h"
#include "sim/plant/plant.h"
#include "sim/strict_json.h"

namespace stagger::server {

/// {"vx","vy","wz"}; what is left out is 0. Limits: |vx| 0.5 m/s, |vy| 0.3 m/s, |wz| 0.5 rad/s.
engine::WalkCommand read_walk(sim::JsonReader& reader);
Json walk_json(const engine::WalkCommand& walk);

/// A strategy that users may switch.
struct Strategy {
  std::string_view name;
  bool engine::Strategies::*member;
};
inline constexpr std::array<Strategy, 4> strategies{{{"ankle", &engine::Strategies::ankle},
                                                     {"hip", &engine::Strategies::hip},
                                                     {"step", &engine::Strategies::step},
                                                     {"time", &engine::Strategies::time}}};

/// Which strategies are to be changed; the others stay as they are.
struct StrategyPatch {
  std::array<std::optional<bool>, strategies.size()> wanted;
  engine::Strategies applied_to(engine::Strategies present) const;
};

/// {"ankle":true,"hip":true,"step":false,"time":true}, each of them optional.
StrategyPatch read_strategies(sim::JsonReader& reader);
Json strategies_json(const engine::Strategies& present);

/// The field `name`, ["ankle","hip","step","time"]: those that may act. Nothing when the field is
/// left out.
std::optional<engine::Strategies> read_strategy_names(sim::JsonReader& reader,
                                                      std::string_view name);
Json strategy_names_json(const engine::Strategies& present);

std::string_view name_of(sim::PlantKind plant);
std::string_view name_of(sim::WalkingState state);
/// The plant of that name, for the command line.
std::optional<sim::PlantKind> plant_of(std::string_view name);
/// The field "plant", or nothing when it is left out.
std::optional<sim::PlantKind> read_plant(sim::JsonReader& reader);
/// The field "seed", 0 to 2^53 (what JSON's numbers hold exactly), or nothing when it is left out.
std::optional<std::uint64_t> read_seed(sim::JsonReader& reader);

}  // namespace stagger::server
