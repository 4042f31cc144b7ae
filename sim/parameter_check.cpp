// What may be asked of the parameters in the table.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>

#include "engine/tuning.h"
#include "sim/parameter_table.h"
#include "sim/simulation.h"

namespace stagger::sim {
namespace {

std::string shown(double value, std::string_view unit) {
  std::ostringstream text;
  text.precision(9);
  text << value;
  if (!unit.empty()) text << ' ' << unit;
  return text.str();
}

/// Products of decimal numbers, without what binary ones make of them.
double to_few_digits(double value) {
  if (value == 0.0) return value;
  const double scale = std::pow(10.0, 5.0 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

std::string fault_of(const ParameterInfo& info, double value, double own) {
  const ParameterRange range = allowed(info, own);
  const bool within = value >= range.least && value <= range.most;
  if (info.kind == ParameterKind::flag) {
    return value == 0.0 || value == 1.0 ? "" : "is " + shown(value, "") + "; allowed: 0 or 1";
  }
  const bool whole = info.kind != ParameterKind::whole || value == std::floor(value);
  if (within && whole) return {};
  return "is " + shown(value, "") +
         "; allowed: " + (info.kind == ParameterKind::whole ? "a whole number, " : "") +
         shown(range.least, "") + " to " + shown(range.most, info.unit);
}

/// The table's name of a parameter that the engine has a rule for.
std::string name_of_engine_parameter(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> names{
      {{"t_ss", "gait.t_ss"},
       {"t_init", "gait.t_init"},
       {"stance_width", "gait.stance_width"},
       {"least_t_ss", "adjust.least_t_ss"},
       {"step_freeze", "adjust.freeze"},
       {"sole_margin", "sole.margin"},
       {"min_step_width", "step.min_width"},
       {"max_step_width", "step.max_width"}}};
  for (const auto& [engine_name, table_name] : names) {
    if (engine_name == name) return std::string(table_name);
  }
  return {};
}

/// The engine's own rules.
std::optional<ParameterFault> engine_fault(const engine::Parameters& p) {
  try {
    engine::Tuning{p};
  } catch (const engine::ParameterError& error) {
    return ParameterFault{name_of_engine_parameter(error.name()),
                          "is " + shown(error.value(), "") + "; allowed: " + error.allowed()};
  } catch (const std::invalid_argument& error) {
    return ParameterFault{"", error.what()};
  }
  return std::nullopt;
}

}  // namespace

ParameterRange allowed(const ParameterInfo& info, double own) {
  if (!info.of_default) return {info.least, info.most};
  // The robot's own value is never out of range, however it was to_few_digits.
  return {std::min(own, to_few_digits(info.least * own)),
          std::max(own, to_few_digits(info.most * own))};
}

std::vector<ParameterFault> check_parameters(const SimulationConfig& config,
                                             const ParameterValues& values) {
  if (values.empty()) return {};
  std::vector<ParameterFault> faults;
  WorldParameters p = default_parameters(config);
  for (const auto& [name, value] : values) {
    const ParameterInfo* info = find_parameter(name);
    if (info == nullptr) {
      faults.push_back({name, "is unknown"});
    } else if (!info->is_of(config.plant)) {
      faults.push_back(
          {name, std::string("is of the plant ") + (info->bullet ? "bullet" : "lipm") + " alone"});
    } else if (std::string fault = fault_of(*info, value, info->get(p)); !fault.empty()) {
      faults.push_back({name, std::move(fault)});
    }
  }
  if (!faults.empty()) return faults;
  set_values(p, values);
  if (auto fault = engine_fault(p.engine)) faults.push_back(std::move(*fault));
  return faults;
}

ParameterValues live_part(const ParameterValues& wanted, const ParameterValues& present) {
  ParameterValues result;
  const auto take = [&result](const ParameterValues& from, TakesEffect when) {
    for (const auto& [name, value] : from) {
      const ParameterInfo* info = find_parameter(name);
      if (info != nullptr && info->takes_effect == when) result[name] = value;
    }
  };
  take(wanted, TakesEffect::next_step);
  take(present, TakesEffect::reset);
  return result;
}

}  // namespace stagger::sim
