// The paper's numbers side by side: ours, the published ones, and what no controller can exceed.
#pragma once

#include <string>
#include <vector>

#include "sim/experiment/paper/paper.h"

namespace stagger::server {

/// One number as text; a cell is empty where there is nothing to say.
struct PaperRow {
  std::string name;
  std::string unit;
  std::string ours;
  std::string noise;      ///< ours under the paper's measurement noise
  std::string published;  ///< by the paper
  std::string ceiling;    ///< of any controller
  std::string percent;    ///< ours of the ceiling
};

struct PaperGroup {
  std::string title;
  std::vector<PaperRow> rows;
};

std::vector<PaperGroup> paper_table(const sim::PaperResults& results);

/// The table for a terminal, in aligned columns.
std::string to_columns(const std::vector<PaperGroup>& groups);

/// "0.8 / 0.2 / 0.6": T_ss, T_ds and what is left of single support [s].
std::string timing_text(const sim::PushTiming& timing);

/// "mass + 10 %, delay 20 ms", or "no error".
std::string error_text(const sim::ModelError& error);
/// Force with an error of the model over the one without: least over the timings.
double least_share(const sim::RobustnessResult& result, const sim::RobustnessResult& without,
                   double sim::StrategyForces::*strategy);

/// "forward", "45° to the left", "backward", ...
std::string direction_text(double direction);

}  // namespace stagger::server
