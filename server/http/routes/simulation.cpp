#include "server/http/problem.h"
#include "server/http/routes/body.h"
#include "server/http/routes/routes.h"
#include "server/json/gait_json.h"
#include "server/json/parameters_json.h"
#include "server/json/senses_json.h"
#include "server/json/terrain_json.h"
#include "sim/state_hash.h"

namespace stagger::server {
namespace {

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json state_json(const SessionState& state, const StreamCounters& stream) {
  Json json{{"session_id", state.session_id},
            {"robot", state.robot},
            {"plant", name_of(state.plant)},
            {"seed", state.seed}};
  write_senses(json, state.plant, state.senses);
  json.update({{"terrain", terrain_json(state.terrain)},
               {"tick", state.tick},
               {"time_s", state.time_s},
               {"running", state.running},
               {"walking_state", name_of(state.walking_state)},
               {"walking", state.walking_state != sim::WalkingState::idle && !state.fallen},
               {"walk", walk_json(state.walk)},
               {"fallen", state.fallen},
               {"fall_reason", text_or_null(state.fall_reason)},
               {"strategies", strategies_json(state.strategies)},
               {"step_count", state.step_count},
               {"worst_dcm_error_m", state.worst_dcm_error_m},
               {"parameters", parameter_values_json(*state.parameters)},
               {"speed", state.speed ? Json(*state.speed) : Json("max")},
               {"real_time_factor", state.real_time_factor},
               {"late_ticks", state.late_ticks},
               {"worst_lateness_ms", state.worst_lateness_ms},
               {"stream",
                {{"clients", stream.clients},
                 {"dropped_clients", stream.dropped_clients},
                 {"dropped_messages", stream.dropped_messages}}},
               {"state_hash", sim::to_hex(state.state_hash)},
               {"error", text_or_null(state.error)},
               {"version", STAGGER_VERSION}});
  return json;
}

HttpResponse set_speed(const HttpRequest& request, Services& services) {
  std::optional<double> factor;
  read_body(request, false, [&factor](sim::JsonReader& reader) {
    const nlohmann::json* value = reader.value("factor");
    if (value != nullptr && *value == "max") return;
    const auto range = sim::Range::between(LiveSession::slowest, LiveSession::fastest,
                                           R"(times real time, or "max")");
    factor = reader.number("factor", range);
  });
  Json answer = effect_json(services.session.set_speed(factor, source_of(request)));
  answer["speed"] = factor ? Json(*factor) : Json("max");
  return json_response(answer);
}

HttpResponse reset(const HttpRequest& request, Services& services) {
  const SessionState present = services.session.state();
  std::string robot = present.robot;
  sim::SimulationConfig config;
  config.strategies = present.strategies;
  read_body(request, true, [&](sim::JsonReader& reader) {
    robot = reader.string_or("robot", present.robot);
    config.plant = read_plant(reader).value_or(present.plant);
    config.seed = read_seed(reader).value_or(present.seed);
    config.senses = read_senses(reader, present.senses);
    config.terrain = present.terrain;
    reader.optional_object(
        "terrain", [&](sim::JsonReader& terrain) { config.terrain = read_terrain(terrain); });
    refuse_terrain_of_lipm(reader, config.plant, config.terrain);
    // Another robot, or another plant, has parameters of its own.
    const bool same = robot == present.robot && config.plant == present.plant;
    config.parameters =
        read_parameters(reader).value_or(same ? *present.parameters : sim::ParameterValues());
  });
  config.robot = services.robots.find(robot);
  if (config.robot == nullptr) {
    sim::JsonErrors errors;
    errors.add("/robot", services.robots.unknown(robot));
    throw Problem(errors);
  }
  sim::JsonErrors errors;
  add_faults(errors, "/parameters", sim::check_parameters(config, config.parameters));
  if (!errors.empty()) throw Problem(errors);
  Json answer = effect_json(services.session.reset(config, source_of(request)));
  answer["session_id"] = services.session.state().session_id;
  return json_response(answer);
}

}  // namespace

void add_simulation_routes(Router& router, Services& services) {
  const std::string base = "/api/v1/simulation";
  router.add("GET", base, [&](const HttpRequest&) {
    return json_response(state_json(services.session.state(), services.hub.counters()));
  });
  router.add("POST", base + "/pause", [&](const HttpRequest& request) {
    expect_no_fields(request);
    return json_response(effect_json(services.session.pause(source_of(request))));
  });
  router.add("POST", base + "/resume", [&](const HttpRequest& request) {
    expect_no_fields(request);
    return json_response(effect_json(services.session.resume(source_of(request))));
  });
  router.add("POST", base + "/step", [&](const HttpRequest& request) {
    std::int64_t ticks = 1;
    read_body(request, true, [&ticks](sim::JsonReader& reader) {
      ticks = reader.integer_or("ticks", 1, sim::Range::between(1, LiveSession::max_step_ticks));
    });
    return json_response(
        effect_json(services.session.step(static_cast<std::uint64_t>(ticks), source_of(request))));
  });
  router.add("POST", base + "/speed",
             [&](const HttpRequest& request) { return set_speed(request, services); });
  router.add("POST", base + "/reset",
             [&](const HttpRequest& request) { return reset(request, services); });
}

}  // namespace stagger::server
