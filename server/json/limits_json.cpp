#include "server/json/limits_json.h"

#include "server/json/push_json.h"
#include "server/json/trial_json.h"
#include "sim/engine_setup.h"
#include "sim/experiment/recovery.h"
#include "sim/simulation.h"

namespace stagger::server {
namespace {

engine::Parameters parameters_of(const sim::LimitsSpec& spec, const sim::Robot& robot) {
  sim::WorldParameters parameters;
  parameters.engine = sim::engine_parameters(robot, spec.trial.plant, spec.trial.strategies,
                                             sim::Simulation::tick_s);
  sim::set_values(parameters, spec.trial.parameters);
  return parameters.engine;
}

Json conditions_json(const sim::LimitsSpec& spec, const sim::Robot& robot) {
  const engine::Parameters p = parameters_of(spec, robot);
  // Whatever a trial can be told is a condition, but for what differs from trial to trial.
  Json json = trial_spec_json(spec.trial);
  for (const char* name : {"seed", "stand", "push"}) json.erase(name);
  Json push = push_spec_json(spec.trial.push.value_or(sim::PushSpec{}));
  for (const char* name : {"direction", "impulse_ns", "duration_s", "at_s", "trigger"}) {
    push.erase(name);
  }
  json["push"] = std::move(push);
  const char* leg = "either";
  if (spec.leg) leg = *spec.leg == sim::Side::left ? "left" : "right";
  json["leg"] = leg;
  json["mass_kg"] = robot.model.mass();
  json["com_height_m"] = p.com_height;
  json["omega"] = engine::natural_frequency(p);
  json["t_ss_s"] = p.t_ss;
  json["t_ds_s"] = p.t_ds;
  json["ladder"] = spec.rungs;
  json["seeds"] = spec.seeds;
  json["criteria"] = {{"recover_within_s", spec.recover_within_s},
                      {"tolerance_m", sim::recovery_tolerance},
                      {"up_for_s", spec.trial.observe_s}};
  json["version"] = STAGGER_VERSION;
  return json;
}

}  // namespace

Json limits_json(const sim::LimitsSpec& spec, const std::vector<sim::Limit>& limits,
                 const sim::Robot& robot) {
  const engine::Parameters p = parameters_of(spec, robot);
  const double speed = std::sqrt(p.gravity * p.com_height);
  Json results = Json::array();
  for (const sim::Limit& limit : limits) {
    const auto of_pass = [&](double factor) {
      return limit.pass_dv ? Json(*limit.pass_dv * factor) : Json();
    };
    const bool percent = limit.ceiling_dv && *limit.ceiling_dv > 0.0;
    results.push_back({{"direction_deg", limit.cell.direction_deg},
                       {"phase", limit.cell.phase ? Json(*limit.cell.phase) : Json("standing")},
                       {"duration_s", limit.cell.duration_s},
                       {"seeds", spec.seeds.size()},
                       {"seeds_alike", limit.seeds_alike},
                       {"pass_dv", or_null(limit.pass_dv)},
                       {"fail_dv", or_null(limit.fail_dv)},
                       {"pass_ns", of_pass(robot.model.mass())},
                       {"fr", of_pass(1.0 / speed)},
                       {"ceiling_dv", or_null(limit.ceiling_dv)},
                       {"ceiling_percent", percent ? of_pass(100.0 / *limit.ceiling_dv) : Json()},
                       {"fail_seed", or_null(limit.fail_seed)},
                       {"fail_reason", limit.fail_reason}});
  }
  return {{"conditions", conditions_json(spec, robot)}, {"results", std::move(results)}};
}

}  // namespace stagger::server
