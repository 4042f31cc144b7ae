// What a campaign found, in numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/campaign/check_thresholds.h"
#include "server/campaign/limits.h"
#include "server/campaign/plan.h"
#include "server/campaign/statistics.h"
#include "server/campaign/store.h"
#include "server/json/json.h"

namespace stagger::server::campaign {

enum class State : std::uint8_t {
  complete,
  incomplete,  ///< trials are left to run
  invalid      ///< a trial that was run twice gave two results: nothing here is to be trusted
};

/// The trials that share one value of a factor.
struct Group {
  std::string path;
  Json value;
  Counts counts;
};

struct Summary {
  State state = State::incomplete;
  Counts counts;
  std::string results_hash;
  std::vector<std::uint64_t> mismatches;  ///< numbers of the trials that did not repeat
  std::vector<Group> groups;              ///< of factors with a set of values
  std::vector<CellLimit> limits;          ///< of a bisection
  std::vector<ThresholdResult> thresholds;
  double cpu_s = 0.0;        ///< of all trials, each run once [s]
  double simulated_s = 0.0;  ///< the same [s]

  bool thresholds_passed() const;
};

/// Reads the store twice, whatever its size, and keeps no trial.
Summary summarize(const Plan& plan, const Store& store);

/// Share of falls among the trials that count: those that recovered or fell.
std::optional<Estimate> fall_rate(const Counts& counts);

}  // namespace stagger::server::campaign
