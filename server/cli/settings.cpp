#include "server/cli/settings.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <vector>

#include "sim/json_file.h"

namespace stagger::server {
namespace {

using Texts = std::vector<std::string>;

std::string variable_of(const CLI::Option& option) {
  std::string name = "STAGGER_" + option.get_lnames().front();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::toupper(c));
  });
  return name;
}

std::string field_of(const CLI::Option& option) {
  std::string name = option.get_lnames().front();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }
bool is_list(const CLI::Option& option) { return option.get_items_expected_max() > 1; }
bool is_number(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.starts_with("INT") || type.starts_with("UINT") || type.starts_with("FLOAT");
}

std::string allowed(const CLI::Option& option) {
  if (is_flag(option)) return "true or false";
  const std::string type = option.get_type_name();
  // The check says more than the type: "INT:INT in [0 - 65535]".
  const std::string check = type.substr(type.find(':') + 1);
  return is_list(option) ? "a list of " + check : check;
}

/// May it come from elsewhere than the command line?
bool is_setting(const CLI::Option* option) {
  return option->get_configurable() && !option->get_lnames().empty() &&
         option->get_lnames().front() != "help";
}

Texts split_at_commas(const std::string& text) {
  Texts parts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    if (comma > start) parts.push_back(text.substr(start, comma - start));
    start = comma + 1;
  }
  return parts;
}

/// As it would stand on the command line; nothing when the JSON is of the wrong kind.
std::optional<std::string> text_of(const nlohmann::json& value, const CLI::Option& option) {
  if (is_flag(option)) {
    return value.is_boolean() ? std::optional(value.dump()) : std::nullopt;
  }
  if (is_number(option)) return value.is_number() ? std::optional(value.dump()) : std::nullopt;
  if (value.is_string()) return value.get<std::string>();
  return value.is_object() ? std::optional(value.dump()) : std::nullopt;
}

std::optional<Texts> texts_of(const nlohmann::json& value, const CLI::Option& option) {
  Texts texts;
  const auto add = [&](const nlohmann::json& item) {
    const auto text = text_of(item, option);
    if (text) texts.push_back(*text);
    return text.has_value();
  };
  if (!is_list(option)) return add(value) ? std::optional(texts) : std::nullopt;
  if (!value.is_array() || !std::all_of(value.begin(), value.end(), add)) return std::nullopt;
  return texts;
}

bool refuse_setting(const std::string& where, const std::string& value,
                    const std::string& allowed) {
  std::cerr << "stagger: " << where << " is " << value << "; allowed: " << allowed << '\n';
  return false;
}

/// Checks and sets; `where` names the source and the field.
bool set(CLI::Option& option, const Texts& texts, const std::string& where,
         const std::string& shown) {
  if (texts.empty()) return true;
  try {
    option.add_result(texts);
    option.run_callback();
    return true;
  } catch (const CLI::ParseError&) {
    return refuse_setting(where, shown, allowed(option));
  }
}

std::optional<nlohmann::json> read_file(const std::string& file) {
  const auto fail = [&file](const std::string& why) {
    std::cerr << "stagger: " << file << ": " << why << '\n';
    return std::nullopt;
  };
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad()) return fail("cannot be read");
  try {
    auto json = sim::parse_json(text);
    if (!json.is_object()) return fail("is not a JSON object");
    return json;
  } catch (const sim::JsonSyntaxError& error) {
    return fail("line " + std::to_string(error.line) + ", column " + std::to_string(error.column) +
                ": " + error.what());
  }
}

bool refuse_unknown(const nlohmann::json& json, const std::vector<CLI::Option*>& options,
                    const std::string& file) {
  bool good = true;
  for (const auto& item : json.items()) {
    const std::string& name = item.key();
    const auto is_it = [&name](const CLI::Option* option) { return field_of(*option) == name; };
    if (std::any_of(options.begin(), options.end(), is_it)) continue;
    std::string known;
    for (const CLI::Option* option : options) {
      known += (known.empty() ? "" : ", ") + field_of(*option);
    }
    std::cerr << "stagger: " << file << ": field \"" << name << "\" is unknown; known: " << known
              << '\n';
    good = false;
  }
  return good;
}

Json json_of(const CLI::Option& option) {
  const Texts& given = option.results();
  if (is_flag(option)) return option.count() > 0 && CLI::detail::to_flag_value(given.back()) > 0;
  if (is_list(option)) return given;
  const std::string text = given.empty() ? option.get_default_str() : given.back();
  if (text.empty()) return nullptr;
  if (!is_number(option)) return text;
  const Json number = Json::parse(text, nullptr, false);
  return number.is_discarded() ? Json(text) : number;
}

}  // namespace

bool apply_settings(CLI::App& command, const std::string& file) {
  const std::vector<CLI::Option*> options = command.get_options(is_setting);
  std::optional<nlohmann::json> json = nlohmann::json::object();
  if (!file.empty()) json = read_file(file);
  if (!json) return false;
  bool good = refuse_unknown(*json, options, file);
  for (CLI::Option* option : options) {
    const std::string variable = variable_of(*option);
    const char* text = std::getenv(variable.c_str());
    const bool in_environment = text != nullptr && *text != '\0';
    if (option->count() > 0) continue;
    if (in_environment) {
      const Texts texts = is_list(*option) ? split_at_commas(text) : Texts{text};
      good = set(*option, texts, variable, '"' + std::string(text) + '"') && good;
      continue;
    }
    const auto value = json->find(field_of(*option));
    // null stands for what is not set, so that what --check-config prints can be read again.
    if (value == json->end() || value->is_null()) continue;
    const std::string where = file + ": field \"" + value.key() + '"';
    const auto texts = texts_of(*value, *option);
    good = (texts ? set(*option, *texts, where, value->dump())
                  : refuse_setting(where, value->dump(), allowed(*option))) &&
           good;
  }
  return good;
}

Json settings_json(const CLI::App& command) {
  Json json = Json::object();
  for (const CLI::Option* option : command.get_options(is_setting)) {
    json[field_of(*option)] = json_of(*option);
  }
  return json;
}

}  // namespace stagger::server
