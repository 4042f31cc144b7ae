// Push limits and their conditions as JSON.
#pragma once

#include "server/json/json.h"
#include "sim/experiment/limits.h"

namespace stagger::server {

/// The fields of docs/limits.md.
Json limits_json(const sim::LimitsSpec& spec, const std::vector<sim::Limit>& limits,
                 const sim::Robot& robot);

}  // namespace stagger::server
