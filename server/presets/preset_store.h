// Named sets of parameters and strategies, a file each.
#pragma once

#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/json/gait_json.h"
#include "sim/strict_json.h"
#include "sim/world_parameters.h"

namespace stagger::server {

struct Preset {
  std::string note;  ///< for people; may be empty
  sim::ParameterValues parameters;
  StrategyPatch strategies;
};

/// {"note","parameters":{...},"strategies":{...}}, all optional. Ranges are left to the robot that
/// it is applied to.
Preset read_preset(sim::JsonReader& reader);
Json preset_json(const std::string& name, const Preset& preset);

/// The folder cannot be written, or is full.
class PresetError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Safe to use from several threads. The folder is made when the first preset is kept.
class PresetStore {
 public:
  static constexpr std::size_t max_presets = 1000;

  explicit PresetStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// 1 to 64 of a-z, 0-9, '-' and '_', the first no sign: never a path.
  static bool is_name(const std::string& name);

  /// Sorted.
  std::vector<std::string> names() const;
  /// Nothing when there is none of that name, or its file is no preset (the log says why).
  std::optional<Preset> find(const std::string& name) const;
  /// True when it is new. The file is replaced as a whole. Throws PresetError.
  bool put(const std::string& name, const Preset& preset);
  /// False when there is none of that name.
  bool remove(const std::string& name);

 private:
  std::filesystem::path file_of(const std::string& name) const;

  std::filesystem::path folder_;
  mutable std::mutex mutex_;
};

}  // namespace stagger::server
