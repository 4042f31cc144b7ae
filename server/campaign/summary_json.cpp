#include "server/campaign/summary_json.h"

namespace stagger::server::campaign {
namespace {

std::string_view name_of(State state) {
  switch (state) {
    case State::complete:
      return "complete";
    case State::incomplete:
      return "incomplete";
    case State::invalid:
      return "invalid";
  }
  return "incomplete";
}

void write_counts(Json& json, const Counts& counts) {
  json["trials"] = counts.trials;
  json["recovered"] = counts.recovered;
  json["fell"] = counts.fell;
  json["timeout"] = counts.timeout;
  json["invalid"] = counts.invalid;
  json["passed"] = counts.passed;
  json["fall_rate"] = estimate_json(fall_rate(counts));
}

Json limit_json(const CellLimit& found) {
  Json json{{"values", found.values},           {"pass", or_null(found.pass)},
            {"fail", or_null(found.fail)},      {"highest_pass", or_null(found.highest_pass)},
            {"monotone", found.limit.monotone}, {"undecided", found.limit.undecided},
            {"done", found.limit.done},         {"trials", found.limit.trials}};
  const auto& push = found.at_pass;
  json["pass_ns"] = push ? Json(push->impulse_ns) : Json();
  json["pass_n"] = push ? Json(push->force_n) : Json();
  json["pass_dv"] = push ? Json(push->delta_v) : Json();
  json["fr"] = push ? Json(push->fr) : Json();
  json["ceiling_dv"] = or_null(found.ceiling_dv);
  const bool percent = push && found.ceiling_dv && *found.ceiling_dv > 0.0;
  json["ceiling_percent"] = percent ? Json(100.0 * push->delta_v / *found.ceiling_dv) : Json();
  return json;
}

}  // namespace

Json estimate_json(const std::optional<Estimate>& estimate) {
  if (!estimate) return nullptr;
  return {{"value", estimate->value}, {"low", estimate->low}, {"high", estimate->high}};
}

Json conditions_json(const Plan& plan) {
  const PlannedTrial first = plan.trial(0);
  Json conditions = first.resolved;
  if (conditions.is_object()) {
    conditions.erase("seed");
    // A field that a factor sets, or one that holds such a field, is no condition.
    for (const auto& [path, value] : first.values.items()) {
      conditions.erase(path_steps(path).front());
    }
  }
  return {{"trial", std::move(conditions)}, {"base", plan.spec().base}};
}

Json summary_json(const Plan& plan, const Store& store, const Summary& summary) {
  const CampaignSpec& spec = plan.spec();
  Json json{{"format", 1},
            {"name", spec.name},
            {"version", store.version()},
            {"state", name_of(summary.state)},
            {"results_hash", summary.results_hash},
            {"most_trials", plan.design().most_trials()}};
  write_counts(json, summary.counts);
  json["run_twice"] = summary.counts.twice;
  json["mismatches"] = summary.mismatches;
  json["pass"] = {{"recover_within_s", or_null(spec.recover_within_s)}};
  json["conditions"] = conditions_json(plan);
  json["groups"] = Json::array();
  for (const Group& group : summary.groups) {
    Json item{{"path", group.path}, {"value", group.value}};
    write_counts(item, group.counts);
    json["groups"].push_back(std::move(item));
  }
  if (plan.design().is_bisection()) json["axis"] = spec.design.bisection.axis;
  json["limits"] = Json::array();
  for (const CellLimit& limit : summary.limits) json["limits"].push_back(limit_json(limit));
  json["thresholds"] = Json::array();
  for (const ThresholdResult& result : summary.thresholds) {
    json["thresholds"].push_back(
        {{"expr", result.text}, {"value", or_null(result.value)}, {"passed", result.passed}});
  }
  const auto per_core_second = [&](double what) {
    return summary.cpu_s > 0.0 ? Json(what / summary.cpu_s) : Json();
  };
  json["cost"] = {
      {"cpu_s", summary.cpu_s},
      {"simulated_s", summary.simulated_s},
      {"trials_per_core_second", per_core_second(static_cast<double>(summary.counts.trials))},
      {"real_time_factor", per_core_second(summary.simulated_s)}};
  return json;
}

}  // namespace stagger::server::campaign
