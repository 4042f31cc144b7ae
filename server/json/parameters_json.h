// Parameters by name: of requests, trials, presets and the command line.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "server/json/json.h"
#include "sim/parameter_table.h"
#include "sim/simulation.h"
#include "sim/strict_json.h"

namespace stagger::server {

/// What is to be changed; nothing stands for the robot's own value.
using ParameterPatch = std::map<std::string, std::optional<double>, std::less<>>;

/// An object {"gait.t_ss":0.4,"hip.in_steps":true}; with `may_be_null` null takes a value back.
/// Names and types are checked here; ranges are those of a robot: see add_faults().
ParameterPatch read_parameter_patch(const nlohmann::json& object, sim::JsonErrors& errors,
                                    const std::string& pointer, bool may_be_null);

/// The field "parameters" of a specification; nothing when it is left out.
std::optional<sim::ParameterValues> read_parameters(sim::JsonReader& reader);

/// "gait.t_ss=0.4" of the command line. Adds to `values`; returns what is wrong, else nothing.
std::optional<std::string> parse_parameter(const std::string& text, sim::ParameterValues& values);

sim::ParameterValues patched(sim::ParameterValues values, const ParameterPatch& patch);

/// Numbers, and true or false for flags.
Json parameter_values_json(const sim::ParameterValues& values);

/// Adds one error for each fault, at `pointer`/name.
void add_faults(sim::JsonErrors& errors, const std::string& pointer,
                const std::vector<sim::ParameterFault>& faults);

/// {"next_step":[names],"reset":[names]}: what is not in effect yet, by what it waits for.
Json waiting_json(const sim::ParameterValues& wanted, const sim::ParameterValues& active);

/// What is asked for, and how far it has come.
struct ParameterState {
  sim::ParameterValues wanted;  ///< of this world or, where it takes one, of the next
  sim::ParameterValues active;  ///< in effect now
};

/// The parameters of the configuration's plant, each with all that the table knows of it.
Json parameter_table_json(const sim::SimulationConfig& config, const ParameterState& state);

}  // namespace stagger::server
