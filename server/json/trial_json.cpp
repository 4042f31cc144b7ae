#include "server/json/trial_json.h"

#include "server/json/gait_json.h"
#include "server/json/parameters_json.h"
#include "server/json/push_json.h"
#include "server/json/robot_json.h"
#include "server/json/senses_json.h"
#include "server/json/terrain_json.h"
#include "sim/state_hash.h"

namespace stagger::server {
namespace {

/// More pushes than that are more than one trial.
constexpr double most_pushes = 1000;

/// What became of one push of a list.
Json outcome_json(const sim::PushOutcome& push) {
  const char* outcome = "recovered";
  if (!push.start_tick) {
    outcome = "never_began";
  } else if (push.fell) {
    outcome = "fell";
  } else if (!push.recovery_time_s) {
    outcome = "not_back";
  }
  return {{"outcome", outcome},
          {"start_tick", or_null(push.start_tick)},
          {"end_tick", or_null(push.end_tick)},
          {"delivered_ns", push.delivered_ns},
          {"steps_to_recover", or_null(push.steps_to_recover)},
          {"recovery_time_s", or_null(push.recovery_time_s)}};
}

}  // namespace

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
    if (reader.value("pushes") != nullptr) {
      if (spec.push) reader.refuse("pushes", "cannot be given together with push");
      reader.object_list("pushes", Range::between(1, most_pushes),
                         [&](sim::JsonReader& push) { spec.pushes.push_back(read_push(push)); });
    }
    spec.parameters = read_parameters(reader).value_or(spec.parameters);
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
  if (!spec.pushes.empty()) {
    json["pushes"] = Json::array();
    for (const sim::PushSpec& push : spec.pushes) json["pushes"].push_back(push_spec_json(push));
  }
  if (!spec.parameters.empty()) json["parameters"] = parameter_values_json(spec.parameters);
  return json;
}

Json trial_result_json(const sim::TrialResult& result, const sim::TrialSpec& spec) {
  Json json{{"outcome", name_of(result.outcome)},
            {"reason", result.reason},
            {"delivered_ns", result.delivered_ns},
            {"steps_to_recover", or_null(result.steps_to_recover)},
            {"recovery_time_s", or_null(result.recovery_time_s)},
            {"fall_time_s", or_null(result.fall_time_s)},
            {"push_tick", or_null(result.push_tick)},
            {"worst_dcm_error_m", result.worst_dcm_error_m},
            {"ticks", result.ticks},
            {"state_hash", sim::to_hex(result.state_hash)}};
  if (!spec.pushes.empty()) {
    json["pushes"] = Json::array();
    for (const sim::PushOutcome& push : result.pushes) json["pushes"].push_back(outcome_json(push));
  }
  json["spec"] = trial_spec_json(spec);
  json["version"] = STAGGER_VERSION;
  return json;
}

void check_for_robot(const sim::TrialSpec& spec, const std::shared_ptr<const sim::Robot>& robot,
                     sim::JsonErrors& errors) {
  if (spec.push) {
    if (const auto wrong = check_link(spec.push->link, *robot)) errors.add("/push/link", *wrong);
  }
  for (std::size_t i = 0; i < spec.pushes.size(); ++i) {
    if (const auto wrong = check_link(spec.pushes[i].link, *robot)) {
      errors.add("/pushes/" + std::to_string(i) + "/link", *wrong);
    }
  }
  sim::SimulationConfig config;
  config.robot = robot;
  config.plant = spec.plant;
  config.strategies = spec.strategies;
  config.senses = spec.senses;
  config.terrain = spec.terrain;
  add_faults(errors, "/parameters", sim::check_parameters(config, spec.parameters));
}

}  // namespace stagger::server
