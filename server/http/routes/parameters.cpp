#include "server/http/problem.h"
#include "server/http/routes/body.h"
#include "server/http/routes/routes.h"
#include "server/json/parameters_json.h"

namespace stagger::server {
namespace {

HttpResponse change_parameters(const HttpRequest& request, Services& services) {
  sim::JsonErrors errors;
  const ParameterPatch patch = read_parameter_patch(json_body(request), errors, "", true);
  if (!errors.empty()) throw Problem(errors);
  try {
    const ParameterEffect result = services.session.change_parameters(
        [&patch](const sim::ParameterValues& present) { return patched(present, patch); },
        source_of(request));
    Json answer = effect_json(result.effect);
    answer["parameters"] = parameter_values_json(result.wanted);
    answer["waits_for"] = waiting_json(result.wanted, result.active);
    return json_response(answer);
  } catch (const ParametersRefused& refused) {
    add_faults(errors, "", refused.faults);
    throw Problem(errors);
  }
}

}  // namespace

void add_parameter_routes(Router& router, Services& services) {
  router.add("GET", "/api/v1/parameters", [&](const HttpRequest&) {
    const SessionState state = services.session.state();
    return json_response(parameter_table_json(services.hub.session()->config,
                                              {*state.parameters, *state.active_parameters}));
  });
  router.add("PATCH", "/api/v1/parameters",
             [&](const HttpRequest& request) { return change_parameters(request, services); });
}

}  // namespace stagger::server
