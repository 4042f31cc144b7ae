#include "server/presets/preset_store.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <fstream>
#include <system_error>

#include "server/json/parameters_json.h"
#include "sim/json_file.h"

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_name = 64;
constexpr std::size_t max_note = 1000;
constexpr std::uintmax_t max_file = 1 << 20;
constexpr const char* extension = ".json";

Json strategies_of(const StrategyPatch& patch) {
  Json json = Json::object();
  for (std::size_t i = 0; i < strategies.size(); ++i) {
    if (patch.wanted[i]) json[std::string(strategies[i].name)] = *patch.wanted[i];
  }
  return json;
}

Json content(const Preset& preset) {
  Json json = Json::object();
  if (!preset.note.empty()) json["note"] = preset.note;
  json["parameters"] = parameter_values_json(preset.parameters);
  json["strategies"] = strategies_of(preset.strategies);
  return json;
}

}  // namespace

Preset read_preset(sim::JsonReader& reader) {
  Preset preset;
  preset.note = reader.string_or("note", {}, max_note);
  preset.parameters = read_parameters(reader).value_or(preset.parameters);
  reader.optional_object("strategies", [&preset](sim::JsonReader& chosen) {
    preset.strategies = read_strategies(chosen);
  });
  return preset;
}

Json preset_json(const std::string& name, const Preset& preset) {
  Json json{{"name", name}};
  json.update(content(preset));
  return json;
}

bool PresetStore::is_name(const std::string& name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  return !name.empty() && name.size() <= max_name && letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return letter(c) || c == '-' || c == '_'; });
}

fs::path PresetStore::file_of(const std::string& name) const {
  return folder_ / (name + extension);
}

std::vector<std::string> PresetStore::names() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator file(folder_, error), end; !error && file != end;
       file.increment(error)) {
    const std::string name = file->path().stem().string();
    if (file->path().extension() == extension && is_name(name)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<Preset> PresetStore::find(const std::string& name) const {
  if (!is_name(name)) return std::nullopt;
  const std::lock_guard lock(mutex_);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file_of(name), error);
  if (error) return std::nullopt;
  try {
    if (size > max_file) throw std::runtime_error("is too large for a preset");
    Preset preset;
    sim::read_json_file(file_of(name),
                        [&preset](sim::JsonReader& reader) { preset = read_preset(reader); });
    return preset;
  } catch (const std::exception& wrong) {
    spdlog::warn("preset {}: {}", name, wrong.what());
    return std::nullopt;
  }
}

bool PresetStore::put(const std::string& name, const Preset& preset) {
  if (!is_name(name)) throw PresetError("\"" + name + "\" cannot be the name of a preset");
  const std::vector<std::string> present = names();
  const bool is_new = !std::binary_search(present.begin(), present.end(), name);
  if (is_new && present.size() >= max_presets) {
    throw PresetError("there are " + std::to_string(max_presets) + " presets; delete one first");
  }
  const std::lock_guard lock(mutex_);
  std::error_code error;
  fs::create_directories(folder_, error);
  const fs::path fresh = folder_ / (name + ".new");
  {
    std::ofstream out(fresh, std::ios::binary | std::ios::trunc);
    out << content(preset).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
    if (!out.flush()) throw PresetError("the folder of presets cannot be written");
  }
  // Whoever reads it, after a crash too, finds the old preset or the new one.
  fs::rename(fresh, file_of(name), error);
  if (error) throw PresetError("the folder of presets cannot be written");
  return is_new;
}

bool PresetStore::remove(const std::string& name) {
  if (!is_name(name)) return false;
  const std::lock_guard lock(mutex_);
  std::error_code error;
  return fs::remove(file_of(name), error);
}

}  // namespace stagger::server
