// A campaign's specification: which trials, and what has to come out. docs/campaign.md explains it.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/campaign/threshold.h"
#include "sim/strict_json.h"

namespace stagger::server::campaign {

/// A field of the trial, "push.trigger.fraction", and a value for it.
using Setting = std::pair<std::string, nlohmann::json>;

/// Numbers to draw from.
struct Interval {
  double lo = 0.0;
  double hi = 1.0;
  bool logarithmic = false;  ///< then the logarithm is spread evenly
};

/// A field of the trial that the campaign varies.
struct Factor {
  std::string path;
  std::vector<nlohmann::json> values;  ///< to choose from; empty with an interval
  std::optional<Interval> interval;    ///< of random designs only
  bool listed = false;                 ///< the values stand in the specification one by one
};

/// One trial of a list, with a name for people.
struct Entry {
  std::string name;
  std::vector<Setting> settings;
};

enum class DesignKind : std::uint8_t {
  grid,    ///< every combination of the factors
  list,    ///< the entries, each with every combination of the factors
  random,  ///< factors drawn
  bisect   ///< for each combination, how far one field may go
};

/// The search for the greatest value of a field at which every repeat passes.
struct Bisection {
  std::string axis;
  double lo = 0.0;
  double hi = 0.0;
  double tol = 0.0;      ///< between two neighbouring levels
  std::size_t scan = 5;  ///< levels of the coarse scan, lo and hi among them
};

struct DesignSpec {
  DesignKind kind = DesignKind::grid;
  std::uint64_t repeats = 1;  ///< of each combination, with seeds of their own
  std::vector<Entry> entries;
  std::uint64_t samples = 0;  ///< of a random design
  Bisection bisection;
};

struct CampaignSpec {
  std::string name;
  std::uint64_t seed = 1;
  nlohmann::json base;  ///< what all trials share: docs/trial.md, and docs/campaign.md on pushes
  DesignSpec design;
  std::vector<Factor> factors;  ///< in the order of their paths
  std::vector<Threshold> thresholds;
  /// To pass, a robot has also to be back within this time after its push [s].
  std::optional<double> recover_within_s;
  double trial_timeout_s = 120.0;      ///< a trial that could take more simulated time is refused
  std::uint64_t max_trials = 100'000;  ///< a campaign that could need more is refused
};

/// What a path leads through: ["push", "trigger", "fraction"]; ["parameters", "gait.t_ss"].
std::vector<std::string> path_steps(const std::string& path);
/// The same as a JSON pointer.
std::string path_pointer(const std::string& path);

/// Reads a specification strictly. Adds what is wrong to `errors`; the one that is returned counts
/// only when nothing was added. The trials themselves are looked at by check_plan().
CampaignSpec read_campaign(const nlohmann::json& body, sim::JsonErrors& errors);

}  // namespace stagger::server::campaign
