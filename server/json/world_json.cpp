#include "server/json/world_json.h"

#include "server/json/gait_json.h"
#include "server/json/parameters_json.h"
#include "server/json/push_json.h"
#include "server/json/senses_json.h"
#include "server/json/step_list_json.h"
#include "server/json/terrain_json.h"

namespace stagger::server {
namespace {

struct CommandJson {
  Json operator()(const sim::Walk& walk) const { return {{"walk", walk_json(walk.command)}}; }
  Json operator()(const sim::StopWalking& /*none*/) const { return {{"stop", Json::object()}}; }
  Json operator()(const sim::SetStrategies& set) const {
    return {{"strategies", strategies_json(set.strategies)}};
  }
  Json operator()(const sim::FollowSteps& follow) const {
    return {{"steps", steps_json(follow.steps)}};
  }
  Json operator()(const sim::SetParameters& set) const {
    return {{"parameters", parameter_values_json(set.values)}};
  }
  Json operator()(const sim::StartPush& push) const {
    return {{"push", push_spec_json(push.spec)}};
  }
  Json operator()(const sim::CancelPush& cancel) const {
    return {{"cancel_push", {{"id", cancel.id}}}};
  }
};

}  // namespace

Json world_json(const sim::SimulationConfig& config) {
  Json json{{"robot", config.robot->name}, {"plant", name_of(config.plant)}, {"seed", config.seed}};
  json["strategies"] = strategies_json(config.strategies);
  // The pendulum has neither; and what is written here is read again.
  if (config.plant == sim::PlantKind::bullet) write_senses(json, config.plant, config.senses);
  json["terrain"] = terrain_json(config.terrain);
  json["self_collision"] = config.physics.self_collision;
  if (!config.parameters.empty()) json["parameters"] = parameter_values_json(config.parameters);
  return json;
}

WorldSpec read_world(sim::JsonReader& reader) {
  WorldSpec world;
  sim::SimulationConfig& config = world.config;
  world.robot = reader.string("robot");
  config.plant = read_plant(reader).value_or(config.plant);
  config.seed = read_seed(reader).value_or(config.seed);
  reader.object("strategies", [&config](sim::JsonReader& present) {
    config.strategies = read_strategies(present).applied_to(config.strategies);
  });
  config.senses = read_senses(reader, config.senses);
  reader.object("terrain",
                [&config](sim::JsonReader& terrain) { config.terrain = read_terrain(terrain); });
  refuse_terrain_of_lipm(reader, config.plant, config.terrain);
  config.physics.self_collision = reader.boolean("self_collision");
  config.parameters = read_parameters(reader).value_or(config.parameters);
  return world;
}

Json command_json(const sim::WorldCommand& command) { return std::visit(CommandJson{}, command); }

std::optional<sim::WorldCommand> read_command(sim::JsonReader& reader) {
  std::optional<sim::WorldCommand> command;
  reader.optional_object("walk",
                         [&](sim::JsonReader& walk) { command = sim::Walk{read_walk(walk)}; });
  reader.optional_object("stop", [&](sim::JsonReader&) { command = sim::StopWalking{}; });
  reader.optional_object("strategies", [&](sim::JsonReader& all) {
    command = sim::SetStrategies{read_strategies(all).applied_to({})};
  });
  reader.optional_object("push",
                         [&](sim::JsonReader& push) { command = sim::StartPush{read_push(push)}; });
  reader.optional_object("cancel_push", [&](sim::JsonReader& cancel) {
    command = sim::CancelPush{
        static_cast<std::uint64_t>(cancel.integer("id", sim::Range::between(1, 1e15)))};
  });
  if (reader.value("steps") != nullptr) command = sim::FollowSteps{read_steps(reader)};
  if (const auto values = read_parameters(reader)) command = sim::SetParameters{*values};
  if (!command) reader.refuse("", "is no command that this version knows");
  return command;
}

}  // namespace stagger::server
