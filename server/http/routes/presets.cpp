#include "server/http/problem.h"
#include "server/http/routes/body.h"
#include "server/http/routes/routes.h"
#include "server/json/parameters_json.h"
#include "server/presets/preset_store.h"

namespace stagger::server {
namespace {

std::string preset_name(const HttpRequest& request) { return request.parameters.at("name"); }

Problem no_preset(const std::string& name) {
  return {404, "there is no preset \"" + name.substr(0, 64) + "\""};
}

Preset found(const std::string& name, Services& services) {
  auto preset = services.presets.find(name);
  if (!preset) throw no_preset(name);
  return std::move(*preset);
}

HttpResponse list_presets(Services& services) {
  Json items = Json::array();
  for (const std::string& name : services.presets.names()) {
    if (const auto preset = services.presets.find(name)) {
      items.push_back(preset_json(name, *preset));
    }
  }
  return json_response({{"items", std::move(items)}});
}

HttpResponse put_preset(const HttpRequest& request, Services& services) {
  const std::string name = preset_name(request);
  if (!PresetStore::is_name(name)) {
    throw Problem(422,
                  "the name of a preset has 1 to 64 of a-z, 0-9, - and _, and begins with a "
                  "letter or a digit");
  }
  Preset preset;
  read_body(request, false, [&](sim::JsonReader& reader) { preset = read_preset(reader); });
  try {
    const bool is_new = services.presets.put(name, preset);
    return json_response(preset_json(name, preset), is_new ? 201 : 200);
  } catch (const PresetError& error) {
    throw Problem(409, error.what());
  }
}

HttpResponse apply(const HttpRequest& request, Services& services) {
  expect_no_fields(request);
  const std::string name = preset_name(request);
  const Preset preset = found(name, services);
  const engine::Strategies chosen =
      preset.strategies.applied_to(services.session.state().strategies);
  try {
    const ParameterEffect result = services.session.change_parameters(
        [&preset](const sim::ParameterValues&) { return preset.parameters; }, source_of(request),
        chosen);
    Json answer = effect_json(result.effect);
    answer["preset"] = name;
    answer["parameters"] = parameter_values_json(result.wanted);
    answer["waits_for"] = waiting_json(result.wanted, result.active);
    answer["strategies"] = strategies_json(chosen);
    return json_response(answer);
  } catch (const ParametersRefused& refused) {
    sim::JsonErrors errors;
    add_faults(errors, "/parameters", refused.faults);
    throw Problem(errors);
  }
}

}  // namespace

void add_preset_routes(Router& router, Services& services) {
  const std::string base = "/api/v1/presets";
  router.add("GET", base, [&](const HttpRequest&) { return list_presets(services); });
  router.add("GET", base + "/{name}", [&](const HttpRequest& request) {
    const std::string name = preset_name(request);
    return json_response(preset_json(name, found(name, services)));
  });
  router.add("PUT", base + "/{name}",
             [&](const HttpRequest& request) { return put_preset(request, services); });
  router.add("DELETE", base + "/{name}", [&](const HttpRequest& request) {
    const std::string name = preset_name(request);
    if (!services.presets.remove(name)) throw no_preset(name);
    return json_response({{"name", name}, {"deleted", true}});
  });
  router.add("POST", base + "/{name}/apply",
             [&](const HttpRequest& request) { return apply(request, services); });
}

}  // namespace stagger::server
