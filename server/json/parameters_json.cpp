#include "server/json/parameters_json.h"

#include <charconv>

namespace stagger::server {
namespace {

using sim::ParameterInfo;
using sim::ParameterKind;

/// A name as a part of a JSON pointer (RFC 6901).
std::string escaped(std::string_view name) {
  std::string text;
  for (const char c : name.substr(0, 100)) {
    if (c == '~') {
      text += "~0";
    } else if (c == '/') {
      text += "~1";
    } else {
      text += c;
    }
  }
  return text;
}

std::optional<double> number_of(const nlohmann::json& value, ParameterKind kind) {
  if (kind == ParameterKind::flag) {
    if (!value.is_boolean()) return std::nullopt;
    return value.get<bool>() ? 1.0 : 0.0;
  }
  if (!value.is_number()) return std::nullopt;
  return value.get<double>();
}

Json shown(const ParameterInfo& info, double value) {
  if (info.kind == ParameterKind::flag) return value != 0.0;
  if (info.kind == ParameterKind::whole) return static_cast<std::int64_t>(value);
  return value;
}

const char* kind_name(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::number:
      return "number";
    case ParameterKind::whole:
      return "integer";
    case ParameterKind::flag:
      return "boolean";
  }
  return "";
}

const char* effect_name(sim::TakesEffect when) {
  return when == sim::TakesEffect::reset ? "reset" : "next_step";
}

double value_in(const sim::ParameterValues& values, const ParameterInfo& info, double own) {
  const auto found = values.find(info.name);
  return found == values.end() ? own : found->second;
}

}  // namespace

ParameterPatch read_parameter_patch(const nlohmann::json& object, sim::JsonErrors& errors,
                                    const std::string& pointer, bool may_be_null) {
  ParameterPatch patch;
  if (!object.is_object()) {
    errors.add(pointer, "is no object; allowed: an object of parameters");
    return patch;
  }
  for (const auto& [name, value] : object.items()) {
    const std::string where = pointer + "/" + escaped(name);
    const ParameterInfo* info = sim::find_parameter(name);
    if (info == nullptr) {
      errors.add(where, "is no parameter; GET /api/v1/parameters lists them");
      continue;
    }
    if (value.is_null() && may_be_null) {
      patch[name] = std::nullopt;
    } else if (const auto number = number_of(value, info->kind)) {
      patch[name] = number;
    } else {
      errors.add(where, std::string("is not of its type; allowed: ") +
                            (info->kind == ParameterKind::flag ? "true or false" : "a number") +
                            (may_be_null ? ", or null for the robot's own value" : ""));
    }
  }
  return patch;
}

std::optional<sim::ParameterValues> read_parameters(sim::JsonReader& reader) {
  const nlohmann::json* object = reader.value("parameters");
  if (object == nullptr) return std::nullopt;
  return patched(
      {}, read_parameter_patch(*object, reader.errors(), reader.pointer("parameters"), false));
}

std::optional<std::string> parse_parameter(const std::string& text, sim::ParameterValues& values) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const ParameterInfo* info = sim::find_parameter(name);
  if (equals == std::string::npos) return "is \"" + text + "\"; allowed: name=value";
  if (info == nullptr) {
    return "\"" + name + "\" is no parameter; `stagger parameters` lists them";
  }
  const std::string given = text.substr(equals + 1);
  if (info->kind == ParameterKind::flag && (given == "true" || given == "false")) {
    values[name] = given == "true" ? 1.0 : 0.0;
    return std::nullopt;
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), value);
  if (error != std::errc() || end != given.data() + given.size()) {
    return name + " is \"" + given + "\"; allowed: a number";
  }
  values[name] = value;
  return std::nullopt;
}

sim::ParameterValues patched(sim::ParameterValues values, const ParameterPatch& patch) {
  for (const auto& [name, value] : patch) {
    if (value) {
      values[name] = *value;
    } else {
      values.erase(name);
    }
  }
  return values;
}

Json parameter_values_json(const sim::ParameterValues& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) {
    const ParameterInfo* info = sim::find_parameter(name);
    json[name] = info != nullptr ? shown(*info, value) : Json(value);
  }
  return json;
}

void add_faults(sim::JsonErrors& errors, const std::string& pointer,
                const std::vector<sim::ParameterFault>& faults) {
  for (const sim::ParameterFault& fault : faults) {
    errors.add(fault.name.empty() ? pointer : pointer + "/" + escaped(fault.name), fault.text);
  }
}

Json waiting_json(const sim::ParameterValues& wanted, const sim::ParameterValues& active) {
  const auto in = [](const sim::ParameterValues& values, std::string_view name) {
    const auto found = values.find(name);
    return found == values.end() ? std::nullopt : std::optional<double>(found->second);
  };
  Json waiting{{"next_step", Json::array()}, {"reset", Json::array()}};
  for (const ParameterInfo& info : sim::parameter_table()) {
    if (in(wanted, info.name) == in(active, info.name)) continue;
    waiting[effect_name(info.takes_effect)].push_back(info.name);
  }
  return waiting;
}

Json parameter_table_json(const sim::SimulationConfig& config, const ParameterState& state) {
  const sim::WorldParameters own_values = sim::default_parameters(config);
  Json items = Json::array();
  for (const ParameterInfo& info : sim::parameter_table()) {
    if (!info.is_of(config.plant)) continue;
    const double own = info.get(own_values);
    const sim::ParameterRange range = sim::allowed(info, own);
    const double wanted = value_in(state.wanted, info, own);
    const double active = value_in(state.active, info, own);
    Json item{
        {"name", info.name},
        {"type", kind_name(info.kind)},
        {"unit", info.unit},
        {"default", shown(info, own)},
        {"value", shown(info, wanted)},
        {"active", shown(info, active)},
        {"takes_effect", effect_name(info.takes_effect)},
        {"waits_for", wanted == active ? Json(nullptr) : Json(effect_name(info.takes_effect))},
        {"meaning", info.meaning}};
    if (info.kind != ParameterKind::flag) {
      item["least"] = shown(info, range.least);
      item["most"] = shown(info, range.most);
    }
    items.push_back(std::move(item));
  }
  return {{"items", std::move(items)}};
}

}  // namespace stagger::server
