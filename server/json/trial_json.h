// The one trial specification, and the result of a trial, as JSON.
#pragma once

#include <memory>
#include <string_view>

#include "server/json/json.h"
#include "sim/experiment/trial.h"
#include "sim/strict_json.h"

namespace stagger::server {

/// "recovered", "fell", "timeout" or "invalid".
std::string_view name_of(sim::TrialOutcome outcome);

/// Reads a trial strictly. Adds to `errors` what is wrong; the specification that is returned
/// counts only when nothing was added. The robot is not looked up: see check_for_robot().
sim::TrialSpec read_trial(const nlohmann::json& body, sim::JsonErrors& errors);

/// Adds what does not go with the robot: links of pushes, and parameters.
void check_for_robot(const sim::TrialSpec& spec, const std::shared_ptr<const sim::Robot>& robot,
                     sim::JsonErrors& errors);

/// Every field resolved; reading it again gives the same trial.
Json trial_spec_json(const sim::TrialSpec& spec);

Json trial_result_json(const sim::TrialResult& result, const sim::TrialSpec& spec);

}  // namespace stagger::server
