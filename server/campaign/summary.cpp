#include "server/campaign/summary.h"

#include <algorithm>
#include <map>

#include "sim/simulation.h"
#include "sim/state_hash.h"

namespace stagger::server::campaign {
namespace {

/// Counts the trials of each value of each factor. Values are told apart by their text.
class Groups {
 public:
  explicit Groups(const Plan& plan) {
    const CampaignSpec& spec = plan.spec();
    for (const Entry& entry : spec.design.entries) add("name", entry.name);
    for (const Factor& factor : spec.factors) {
      for (const nlohmann::json& value : factor.values) add(factor.path, value);
    }
  }

  void count(const Json& values, const Record& record) {
    for (const auto& [path, value] : values.items()) {
      const auto found = index_.find({path, to_text(value)});
      if (found == index_.end()) continue;
      Counts& counts = groups_[found->second].counts;
      ++counts.trials;
      if (record.passed) ++counts.passed;
      switch (record.result.outcome) {
        case sim::TrialOutcome::recovered:
          ++counts.recovered;
          break;
        case sim::TrialOutcome::fell:
          ++counts.fell;
          break;
        case sim::TrialOutcome::timeout:
          ++counts.timeout;
          break;
        case sim::TrialOutcome::invalid:
          ++counts.invalid;
          break;
      }
    }
  }
  std::vector<Group> take() { return std::move(groups_); }

 private:
  void add(const std::string& path, const nlohmann::json& value) {
    const Json ordered = value;
    if (!index_.emplace(std::pair(path, to_text(ordered)), groups_.size()).second) return;
    groups_.push_back({path, ordered, {}});
  }

  std::vector<Group> groups_;
  std::map<std::pair<std::string, std::string>, std::size_t> index_;
};

}  // namespace

bool Summary::thresholds_passed() const {
  return std::all_of(thresholds.begin(), thresholds.end(),
                     [](const ThresholdResult& result) { return result.passed; });
}

std::optional<Estimate> fall_rate(const Counts& counts) {
  return share_of(counts.fell, counts.fell + counts.recovered);
}

Summary summarize(const Plan& plan, const Store& store) {
  Summary summary;
  Groups groups(plan);
  sim::StateHash hash;
  store.for_each([&](const Record& record) {
    hash.mix(hash_of(record));
    if (record.repeated == false) summary.mismatches.push_back(record.number);
    groups.count(Json::parse(record.values), record);
    summary.cpu_s += record.cpu_s;
    summary.simulated_s += static_cast<double>(record.result.ticks) * sim::Simulation::tick_s;
  });
  summary.counts = store.counts();
  summary.results_hash = sim::to_hex(hash.value());
  summary.groups = groups.take();
  summary.limits = limits_of(plan, store);
  summary.thresholds = check_thresholds(plan, store, summary.limits);
  if (!summary.mismatches.empty()) {
    summary.state = State::invalid;
  } else if (plan.design().next_round(store).empty()) {
    summary.state = State::complete;
  }
  return summary;
}

}  // namespace stagger::server::campaign
