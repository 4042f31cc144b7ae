#include "server/http/problem.h"
#include "server/http/routes/body.h"
#include "server/http/routes/routes.h"
#include "server/json/gait_json.h"
#include "server/json/step_list_json.h"

namespace stagger::server {

namespace {

HttpResponse follow(const StepList& list, const HttpRequest& request, Services& services) {
  try {
    Json answer = effect_json(services.session.follow(list.steps, list.frame, source_of(request)));
    answer["steps"] = list.steps.size();
    return json_response(answer);
  } catch (const StepsRefused& refused) {
    sim::JsonErrors errors;
    errors.add("/steps/" + std::to_string(refused.step), refused.what());
    throw Problem(errors);
  }
}

HttpResponse walk(const HttpRequest& request, Services& services) {
  engine::WalkCommand command;
  std::optional<StepList> list;
  read_body(request, true, [&](sim::JsonReader& reader) {
    list = read_step_list(reader);
    if (list) return;
    command = read_walk(reader);
  });
  if (list) return follow(*list, request, services);
  Json answer = effect_json(services.session.walk(command, source_of(request)));
  answer["walk"] = walk_json(command);
  return json_response(answer);
}

}  // namespace

void add_walk_routes(Router& router, Services& services) {
  router.add("POST", "/api/v1/walk",
             [&](const HttpRequest& request) { return walk(request, services); });
  router.add("POST", "/api/v1/stop", [&](const HttpRequest& request) {
    expect_no_fields(request);
    return json_response(effect_json(services.session.stop_walking(source_of(request))));
  });
  router.add("GET", "/api/v1/strategies", [&](const HttpRequest&) {
    return json_response(strategies_json(services.session.state().strategies));
  });
  router.add("PATCH", "/api/v1/strategies", [&](const HttpRequest& request) {
    StrategyPatch patch;
    read_body(request, false,
              [&patch](sim::JsonReader& reader) { patch = read_strategies(reader); });
    const StrategyEffect result = services.session.change_strategies(
        [patch](const engine::Strategies& present) { return patch.applied_to(present); },
        source_of(request));
    Json answer = strategies_json(result.strategies);
    answer.update(effect_json(result.effect));
    return json_response(answer);
  });
}

}  // namespace stagger::server
