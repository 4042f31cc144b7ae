// The one trial specification, and the result of a trial, as JSON.
#pragma once

#include "server/json/json.h"
#include "sim/experiment/trial.h"
#include "sim/strict_json.h"

namespace stagger::server {

/// Reads a trial strictly. Adds to `errors` what is wrong; the specification that is returned
/// counts only when nothing was added. Robot and link are not looked up: see check_link().
sim::TrialSpec read_trial(const nlohmann::json& body, sim::JsonErrors& errors);

/// Every field resolved; reading it again gives the same trial.
Json trial_spec_json(const sim::TrialSpec& spec);

Json trial_result_json(const sim::TrialResult& result, const sim::TrialSpec& spec);

}  // namespace stagger::server
