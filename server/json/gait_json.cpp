#include "server/json/gait_json.h"

#include <algorithm>
#include <cstdint>

namespace stagger::server {
namespace {

using sim::Range;

// What the robots of this project can be asked for; the engine alone would take more.
constexpr double max_vx = 0.5;  // [m/s]
constexpr double max_vy = 0.3;  // [m/s]
constexpr double max_wz = 0.5;  // [rad/s]

constexpr double max_seed = 9007199254740992.0;

const sim::Names<sim::PlantKind>& plants() {
  static const sim::Names<sim::PlantKind> names{{"bullet", sim::PlantKind::bullet},
                                                {"lipm", sim::PlantKind::lipm}};
  return names;
}

}  // namespace

engine::WalkCommand read_walk(sim::JsonReader& reader) {
  engine::WalkCommand walk;
  walk.vx = reader.number_or("vx", 0.0, Range::between(-max_vx, max_vx, "m/s"));
  walk.vy = reader.number_or("vy", 0.0, Range::between(-max_vy, max_vy, "m/s"));
  walk.wz = reader.number_or("wz", 0.0, Range::between(-max_wz, max_wz, "rad/s"));
  return walk;
}

Json walk_json(const engine::WalkCommand& walk) {
  return {{"vx", walk.vx}, {"vy", walk.vy}, {"wz", walk.wz}};
}

engine::Strategies StrategyPatch::applied_to(engine::Strategies present) const {
  for (std::size_t i = 0; i < strategies.size(); ++i) {
    if (wanted[i]) present.*strategies[i].member = *wanted[i];
  }
  return present;
}

StrategyPatch read_strategies(sim::JsonReader& reader) {
  StrategyPatch patch;
  for (std::size_t i = 0; i < strategies.size(); ++i) {
    patch.wanted[i] = reader.optional_boolean(strategies[i].name);
  }
  return patch;
}

Json strategies_json(const engine::Strategies& present) {
  Json json = Json::object();
  for (const Strategy& strategy : strategies) {
    json[std::string(strategy.name)] = present.*strategy.member;
  }
  return json;
}

std::optional<engine::Strategies> read_strategy_names(sim::JsonReader& reader,
                                                      std::string_view name) {
  if (reader.value(name) == nullptr) return std::nullopt;
  engine::Strategies chosen{.ankle = false, .hip = false, .step = false, .time = false};
  for (const std::string& wanted : reader.string_list(name, Range::between(0, 16))) {
    const auto* const found =
        std::find_if(strategies.begin(), strategies.end(),
                     [&wanted](const Strategy& strategy) { return strategy.name == wanted; });
    if (found == strategies.end()) {
      reader.refuse(name, "names \"" + wanted + R"("; allowed: "ankle", "hip", "step", "time")");
    } else if (chosen.*found->member) {
      reader.refuse(name, "names \"" + wanted + "\" twice");
    } else {
      chosen.*found->member = true;
    }
  }
  return chosen;
}

Json strategy_names_json(const engine::Strategies& present) {
  Json names = Json::array();
  for (const Strategy& strategy : strategies) {
    if (present.*strategy.member) names.push_back(std::string(strategy.name));
  }
  return names;
}

std::string_view name_of(sim::PlantKind plant) {
  for (const auto& [name, kind] : plants()) {
    if (kind == plant) return name;
  }
  return "";
}

std::string_view name_of(sim::WalkingState state) {
  switch (state) {
    case sim::WalkingState::idle:
      return "idle";
    case sim::WalkingState::initialize:
      return "initialize";
    case sim::WalkingState::single_support:
      return "single_support";
    case sim::WalkingState::double_support:
      return "double_support";
  }
  return "";
}

std::optional<sim::PlantKind> plant_of(std::string_view name) {
  for (const auto& [known, kind] : plants()) {
    if (known == name) return kind;
  }
  return std::nullopt;
}

std::optional<sim::PlantKind> read_plant(sim::JsonReader& reader) {
  return reader.optional_one_of("plant", plants());
}

std::optional<std::uint64_t> read_seed(sim::JsonReader& reader) {
  const auto seed = reader.optional_integer("seed", Range::between(0.0, max_seed));
  if (!seed) return std::nullopt;
  return static_cast<std::uint64_t>(*seed);
}

}  // namespace stagger::server
