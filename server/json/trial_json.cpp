#include "server/json/trial_json.h"

#include "server/json/gait_json.h"
#include "server/json/push_json.h"
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
    spec.strategies = read_strategy_names(reader, "strategies").value_or(spec.strategies);
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
  Json json{{"robot", spec.robot},
            {"plant", name_of(spec.plant)},
            {"seed", spec.seed},
            {"walk", walk_json(spec.walk)},
            {"strategies", strategy_names_json(spec.strategies)},
            {"terrain", terrain_json(spec.terrain)},
            {"self_collision", spec.self_collision},
            {"settle_s", spec.settle_s},
            {"observe_s", spec.observe_s}};
  if (spec.push) json["push"] = push_spec_json(*spec.push);
  return json;
}

Json trial_result_json(const sim::TrialResult& result, const sim::TrialSpec& spec) {
  return {{"outcome", name_of(result.outcome)},
          {"reason", result.reason},
          {"delivered_ns", result.delivered_ns},
          {"steps_to_recover", or_null(result.steps_to_recover)},
          {"fall_time_s", or_null(result.fall_time_s)},
          {"push_tick", or_null(result.push_tick)},
          {"worst_dcm_error_m", result.worst_dcm_error_m},
          {"ticks", result.ticks},
          {"state_hash", sim::to_hex(result.state_hash)},
          {"spec", trial_spec_json(spec)},
          {"version", STAGGER_VERSION}};
}

}  // namespace stagger::server
