// The one table of parameters that users may change: name, unit, range, meaning, and when a change
// takes effect.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/world_parameters.h"

namespace stagger::sim {

enum class ParameterKind : std::uint8_t { number, whole, flag };

/// When a change is felt in a world that lives.
enum class TakesEffect : std::uint8_t {
  next_step,  ///< at rest at once; in mid-walk where the first step of the new gait lifts off
  reset,      ///< in the next world
};

struct ParameterInfo {
  std::string_view name;
  std::string_view unit;  ///< "" for ratios and flags
  std::string_view meaning;
  double least = 0.0;
  double most = 0.0;
  bool of_default = false;  ///< least and most are multiples of the robot's own value
  ParameterKind kind = ParameterKind::number;
  TakesEffect takes_effect = TakesEffect::next_step;
  bool bullet = true;  ///< means something on the full body
  bool lipm = true;    ///< means something on the pendulum
  double (*get)(const WorldParameters&) = nullptr;
  void (*set)(WorldParameters&, double) = nullptr;

  bool is_of(PlantKind plant) const { return plant == PlantKind::bullet ? bullet : lipm; }
};

/// In the order in which they are shown.
std::span<const ParameterInfo> parameter_table();

/// nullptr when there is none of that name.
const ParameterInfo* find_parameter(std::string_view name);

struct ParameterRange {
  double least = 0.0;
  double most = 0.0;
};

/// What is allowed where this is the robot's own value.
ParameterRange allowed(const ParameterInfo& info, double own);

struct ParameterFault {
  std::string name;  ///< "" when it is of no single one
  std::string text;  ///< "is 3 s; allowed: ..."
};

/// Everything that is wrong with the values in a world of this configuration: names, plants,
/// ranges, and rules between parameters. config.parameters is not looked at.
std::vector<ParameterFault> check_parameters(const SimulationConfig& config,
                                             const ParameterValues& values);

/// Of `wanted` what can change in a world that lives, of `present` the rest.
ParameterValues live_part(const ParameterValues& wanted, const ParameterValues& present);

}  // namespace stagger::sim
