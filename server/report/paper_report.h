// The paper's numbers and figures as one HTML page.
#pragma once

#include <string>

#include "sim/experiment/paper/paper.h"

namespace stagger::server {

/// `command`: what was typed to get these results.
std::string paper_report(const sim::PaperResults& results, const std::string& command);

}  // namespace stagger::server
