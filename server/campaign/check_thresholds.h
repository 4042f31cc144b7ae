// Whether a campaign's thresholds hold.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/campaign/limits.h"
#include "server/campaign/plan.h"
#include "server/campaign/store.h"

namespace stagger::server::campaign {

struct ThresholdResult {
  std::string text;
  std::optional<double> value;  ///< nothing when no trial counts, or a limit is not known
  bool passed = false;
};

/// For the trials so far.
std::vector<ThresholdResult> check_thresholds(const Plan& plan, const Store& store,
                                              const std::vector<CellLimit>& limits);

}  // namespace stagger::server::campaign
