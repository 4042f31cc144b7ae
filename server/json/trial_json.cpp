#include "server/json/trial_json.h"

#include "server/json/gait_json.h"
#include "server/json/push_json.h"
#include "server/json/senses_json.h"
#include "server/json/terrain_json.h"
#include "sim/state_hash.h"

namespace stagger::server {
namespace {

std::string_view name_of(sim::TrialOutcome outcome) {
  switch (outcome) {
    case sim::TrialOutcome::recovered:
      return "recovered";
    case sim::TrialOutcome::fell:
      return "fell";
    case sim::TrialOutcome::timeout:
      return "timeout";
    case sim::TrialOutcome::invalid:
      return "invalid";
  }
  return "invalid";
}

}  // namespace

sim::TrialSpec read_trial(const nlohmann::json& body, sim::JsonErrors& errors) {
  using sim::Range;
  sim::TrialSpec spec;
  sim::read_json(body, errors, [&spec](sim::JsonReader& reader) {
    spec.robot = reader.string("robot");
    spec.plant = read_plant(reader).value_or(spec.plant);
    spec.seed = read_seed(reader).value_or(spec.seed);
    reader.optional_object("walk", [&](sim::JsonReader& walk) { spec.walk = read_walk(walk); });
    spec.stand = reader.boolean_or("stand", spec.stand);
    if (spec.stand && (spec.walk.vx != 0.0 || spec.walk.vy != 0.0 || spec.walk.wz != 0.0)) {
      reader.refuse("stand", "is true; allowed: false, or a walk of velocity 0");
    }
    spec.strategies = read_strategy_names(reader, "strategies").value_or(spec.strategies);
    spec.senses = read_senses(reader, spec.senses);
    reader.optional_object("terrain",
                           [&](sim::JsonReader& terrain) { spec.terrain = read_terrain(terrain); });
    spec.self_collision = reader.boolean_or("self_collision", spec.self_collision);
    refuse_terrain_of_lipm(reader, spec.plant, spec.terrain);
    spec.settle_s = reader.number_or("settle_s", spec.settle_s, Range::between(0.0, 60.0, "s"));
    spec.observe_s = reader.number_or("observe_s", spec.observe_s, Range::between(0.0, 60.0, "s"));
    reader.optional_object("push", [&](sim::JsonReader& push) { spec.push = read_push(push); });
  });
  return spec;
}

Json trial_spec_json(const sim::TrialSpec& spec) {
  Json json{{"robot", spec.robot}, {"plant", name_of(spec.plant)},
            {"seed", spec.seed},   {"walk", walk_json(spec.walk)},
            {"stand", spec.stand}, {"strategies", strategy_names_json(spec.strategies)}};
  // The pendulum has neither; and what is written here is read again.
  if (spec.plant == sim::PlantKind::bullet) write_senses(json, spec.plant, spec.senses);
  json["terrain"] = terrain_json(spec.terrain);
  json["self_collision"] = spec.self_collision;
  json["settle_s"] = spec.settle_s;
  json["observe_s"] = spec.observe_s;
  if (spec.push) json["push"] = push_spec_json(*spec.push);
  return json;
}

Json trial_result_json(const sim::TrialResult& result, const sim::TrialSpec& spec) {
  return {{"outcome", name_of(result.outcome)},
          {"reason", result.reason},
          {"delivered_ns", result.delivered_ns},
          {"steps_to_recover", or_null(result.steps_to_recover)},
          {"recovery_time_s", or_null(result.recovery_time_s)},
          {"fall_time_s", or_null(result.fall_time_s)},
          {"push_tick", or_null(result.push_tick)},
          {"worst_dcm_error_m", result.worst_dcm_error_m},
          {"ticks", result.ticks},
          {"state_hash", sim::to_hex(result.state_hash)},
          {"spec", trial_spec_json(spec)},
          {"version", STAGGER_VERSION}};
}

}  // namespace stagger::server
