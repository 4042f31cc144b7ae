// Lists of numbers on the command line: "0.1,0.35,0.6", "0:345:15", or both.
#pragma once

#include <string>
#include <vector>

#include "sim/strict_json.h"

namespace stagger::server {

/// Numbers and ranges FROM:TO:STEP (TO included when a step meets it), separated by commas. Throws
/// std::invalid_argument that names the option, the value and what is allowed: a number outside
/// `range`, one given twice, or more than 1000 of them.
std::vector<double> read_number_list(const std::string& option, const std::string& text,
                                     const sim::Range& range);

/// The parts of `text` between the separators, empty ones too.
std::vector<std::string> split(const std::string& text, char separator);

/// One number of that option, within the range.
double read_number(const std::string& option, const std::string& text, const sim::Range& range);

}  // namespace stagger::server
