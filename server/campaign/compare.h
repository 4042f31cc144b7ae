// Two campaigns side by side, trial by trial: has something become worse?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/campaign/plan.h"
#include "server/campaign/statistics.h"
#include "server/campaign/store.h"
#include "server/json/json.h"

namespace stagger::server::campaign {

/// Trials are a pair when the campaign set the same and it is the same repeat.
struct PairedGroup {
  std::string path;  ///< of a factor; empty: all trials
  Json value;
  PairedCounts failures;
  std::optional<Estimate> difference;  ///< share that does not pass, B less A
};

/// A measure of the trials that pass in both: B less A.
struct PairedMeasure {
  std::string name;
  std::uint64_t pairs = 0;
  std::optional<Estimate> difference;
};

struct PairedLimit {
  Json values;
  double a = 0.0;  ///< on the axis; 0 when its lowest level fails
  double b = 0.0;
};

struct Tolerance {
  double failures = 0.0;  ///< greater share of trials that do not pass, 0 to 1
  double limit = 0.0;     ///< share of the limit that may be lost, on the mean, 0 to 1
};

struct CampaignComparison {
  std::uint64_t pairs = 0;
  std::uint64_t only_a = 0;  ///< trials without a partner, or whose partner is undecided
  std::uint64_t only_b = 0;
  std::vector<PairedGroup> groups;  ///< the first: all trials
  std::vector<PairedMeasure> measures;
  std::vector<PairedLimit> limits;       ///< of two bisections on the same axis
  std::optional<Estimate> limit_change;  ///< mean of (b - a) / a
  std::vector<std::uint64_t> worse;      ///< numbers in B of trials that passed in A only
  std::vector<std::string> regressions;  ///< one line each; empty: none
};

/// B is worse when over all pairs the share that does not pass has grown beyond the tolerance; when
/// it has for one value of a factor with all of its interval; or when the limits' mean change is.
CampaignComparison compare(const Plan& plan_a, const Store& a, const Plan& plan_b, const Store& b,
                           const Tolerance& tolerance);

Json comparison_json(const CampaignComparison& comparison);

}  // namespace stagger::server::campaign
