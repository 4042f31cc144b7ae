// Push limits as tables: for a terminal, and for the documentation.
#pragma once

#include <string>
#include <vector>

#include "sim/experiment/limits.h"

namespace stagger::server {

/// One line a push, in aligned columns.
std::string limits_columns(const sim::LimitsSpec& spec, const std::vector<sim::Limit>& limits,
                           const sim::Robot& robot);

/// A page: the conditions, and for each duration a table of directions and phases. `command` made
/// it, on the day `date`.
std::string limits_markdown(const sim::LimitsSpec& spec, const std::vector<sim::Limit>& limits,
                            const sim::Robot& robot, const std::string& command,
                            const std::string& date);

}  // namespace stagger::server
