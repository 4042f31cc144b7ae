#include "server/report/campaign_labels.h"

#include <map>

#include "server/report/scale.h"

namespace stagger::server {
namespace {

std::string number_words(const Json& value) {
  constexpr int digits = 4;
  if (!value.is_number_float()) return value.dump();
  std::string text = significant(value.get<double>(), digits);
  if (text.find('.') == std::string::npos || text.find("10^") != std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string joined_words(const Json& list, const std::string& between) {
  std::string text;
  for (const Json& item : list) text += (text.empty() ? "" : between) + flat_words(item);
  return text.empty() ? "none" : text;
}

std::string trigger_words(const Json& trigger) {
  const auto text = [&](const char* name) {
    const auto found = trigger.find(name);
    return found != trigger.end() && found->is_string() ? found->get<std::string>() : "";
  };
  std::string phase = text("phase");
  for (char& c : phase) c = c == '_' ? ' ' : c;
  const std::string leg = text("leg");
  const auto fraction = trigger.find("fraction");
  return (leg.empty() ? "" : leg + " ") + phase +
         (fraction == trigger.end() ? "" : " at " + flat_words(*fraction));
}

}  // namespace

std::string path_words(const std::string& path) {
  static const std::map<std::string, std::string> words{
      {"name", "scenario"},
      {"push.direction_deg", "direction (°)"},
      {"push.fr", "push (Fr)"},
      {"push.delta_v", "push, Δv (m/s)"},
      {"push.impulse_ns", "push (N s)"},
      {"push.force_n", "push (N)"},
      {"push.duration_s", "duration of the push (s)"},
      {"push.trigger", "moment"},
      {"push.trigger.fraction", "fraction of the phase"},
      {"push.trigger.leg", "leg that stands"},
      {"push.trigger.phase", "phase"},
      {"walk.vx", "forward speed (m/s)"},
      {"walk.vy", "speed to the left (m/s)"}};
  const auto found = words.find(path);
  return found == words.end() ? path : found->second;
}

std::string value_words(const std::string& path, const Json& value) {
  if (path == "strategies" && value.is_array()) return joined_words(value, " + ");
  if (path == "push.direction_deg" && value.is_number()) return number_words(value) + "°";
  if (path == "push.trigger" && value.is_object()) return trigger_words(value);
  return flat_words(value);
}

std::string values_words(const Json& values) {
  std::string text;
  for (const auto& [path, value] : values.items()) {
    // A scenario of a list has a name for what it sets.
    const bool named = path != "name" && values.contains("name");
    if (named && (value.is_object() || (value.is_array() && path == "pushes"))) continue;
    std::string name = path_words(path);
    name = name.substr(0, name.find(" ("));
    const bool plain =
        path == "name" || path == "strategies" || path == "push.trigger" || path == "robot";
    text += (text.empty() ? "" : ", ") + (plain ? "" : name + " ") + value_words(path, value);
  }
  return text;
}

std::string flat_words(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return number_words(value);
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_array()) return joined_words(value, ", ");
  if (!value.is_object()) return "none";
  std::string text;
  for (const auto& [name, part] : value.items()) {
    const bool nested = part.is_object();
    text += (text.empty() ? "" : ", ") + name + " " + (nested ? "(" : "") + flat_words(part) +
            (nested ? ")" : "");
  }
  return text.empty() ? "none" : text;
}

}  // namespace stagger::server
