#include "server/campaign/check_thresholds.h"

#include <algorithm>

namespace stagger::server::campaign {
namespace {

using nlohmann::json;

std::optional<double> measure(const std::string& name, const Record& record) {
  const sim::TrialResult& r = record.result;
  if (name == "delta_v") return record.push.delta_v;
  if (name == "fr") return record.push.fr;
  if (name == "delivered_ns") return r.delivered_ns;
  if (name == "worst_dcm_error_m") return r.worst_dcm_error_m;
  if (name == "recovery_time_s") return r.recovery_time_s;
  if (name == "fall_time_s") return r.fall_time_s;
  if (r.steps_to_recover) return static_cast<double>(*r.steps_to_recover);
  return std::nullopt;
}

/// Nothing when the limit is not known; 0 when the lowest level fails: nothing is known below it.
std::optional<double> measure(const std::string& name, const CellLimit& found) {
  if (!found.limit.done || found.limit.undecided) return std::nullopt;
  if (!found.pass) return 0.0;
  if (name == "limit") return found.pass;
  if (!found.at_pass) return std::nullopt;
  if (name == "limit_ns") return found.at_pass->impulse_ns;
  if (name == "limit_dv") return found.at_pass->delta_v;
  if (name == "limit_fr") return found.at_pass->fr;
  if (!found.ceiling_dv || !(*found.ceiling_dv > 0.0)) return std::nullopt;
  return 100.0 * found.at_pass->delta_v / *found.ceiling_dv;
}

/// What a condition asks for, of one trial.
json field(const std::string& path, const Record& record, const json& values, const Plan& plan) {
  if (const auto found = values.find(path); found != values.end()) return *found;
  if (path == "repeat") return record.repeat;
  if (const auto figure = push_figure(path, record.push)) return *figure;
  const Json resolved = plan.trial(record.number).resolved;
  const Json::json_pointer pointer(path_pointer(path));
  return resolved.contains(pointer) ? json(resolved[pointer]) : json();
}

/// Gathers what one threshold needs, trial by trial.
class Gatherer {
 public:
  explicit Gatherer(const Threshold& threshold) : threshold_(threshold) {}

  void take(const Record& record, const json& values, const Plan& plan) {
    const auto holds_here = [&](const Condition& condition) {
      return holds(condition, field(condition.path, record, values, plan));
    };
    const auto& conditions = threshold_.conditions;
    if (!std::all_of(conditions.begin(), conditions.end(), holds_here)) return;
    if (!threshold_.aggregate.function.empty()) {
      if (const auto value = measure(threshold_.aggregate.measure, record)) {
        values_.push_back(*value);
      }
      return;
    }
    ++trials_;
    if (record.passed) ++passed_;
    if (record.result.outcome == sim::TrialOutcome::recovered) ++recovered_;
    if (record.result.outcome == sim::TrialOutcome::fell) ++fell_;
    if (record.result.outcome == sim::TrialOutcome::timeout) ++timeouts_;
    if (record.result.outcome == sim::TrialOutcome::invalid) ++invalid_;
  }

  std::optional<double> value() const {
    if (!threshold_.aggregate.function.empty()) {
      return statistic(threshold_.aggregate.function, values_);
    }
    if (trials_ == 0) return std::nullopt;
    const std::string& name = threshold_.aggregate.measure;
    const auto rate = [this](std::uint64_t hits) -> std::optional<double> {
      const std::uint64_t counted = recovered_ + fell_;
      if (counted == 0) return std::nullopt;
      return static_cast<double>(hits) / static_cast<double>(counted);
    };
    if (name == "fall_rate") return rate(fell_);
    if (name == "pass_rate") return rate(passed_);
    if (name == "falls") return static_cast<double>(fell_);
    if (name == "timeouts") return static_cast<double>(timeouts_);
    if (name == "invalid") return static_cast<double>(invalid_);
    return static_cast<double>(trials_);
  }

 private:
  const Threshold& threshold_;
  std::vector<double> values_;
  std::uint64_t trials_ = 0;
  std::uint64_t recovered_ = 0;
  std::uint64_t passed_ = 0;
  std::uint64_t fell_ = 0;
  std::uint64_t timeouts_ = 0;
  std::uint64_t invalid_ = 0;
};

/// One limit that is not known makes the whole statistic unknown.
std::optional<double> value_of_limits(const Threshold& threshold,
                                      const std::vector<CellLimit>& limits) {
  std::vector<double> values;
  for (const CellLimit& limit : limits) {
    const auto holds_here = [&](const Condition& condition) {
      const auto found = limit.values.find(condition.path);
      return found != limit.values.end() && holds(condition, json(*found));
    };
    const auto& conditions = threshold.conditions;
    if (!std::all_of(conditions.begin(), conditions.end(), holds_here)) continue;
    const auto value = measure(threshold.aggregate.measure, limit);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return statistic(threshold.aggregate.function, std::move(values));
}

}  // namespace

std::vector<ThresholdResult> check_thresholds(const Plan& plan, const Store& store,
                                              const std::vector<CellLimit>& limits) {
  const std::vector<Threshold>& thresholds = plan.spec().thresholds;
  std::vector<Gatherer> gatherers(thresholds.begin(), thresholds.end());
  if (!thresholds.empty()) {
    store.for_each([&](const Record& record) {
      const json values = json::parse(record.values);
      for (Gatherer& gatherer : gatherers) gatherer.take(record, values, plan);
    });
  }
  std::vector<ThresholdResult> results;
  for (std::size_t i = 0; i < thresholds.size(); ++i) {
    const Threshold& threshold = thresholds[i];
    ThresholdResult result{threshold.text, {}, false};
    result.value = is_limit_measure(threshold.aggregate.measure)
                       ? value_of_limits(threshold, limits)
                       : gatherers[i].value();
    // A threshold of no trials has not been passed: a gate that cannot fail is none.
    result.passed = result.value && holds(threshold.comparison, *result.value, threshold.value);
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace stagger::server::campaign
