#include "server/campaign/compare.h"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include "server/campaign/hash.h"
#include "server/campaign/limits.h"
#include "server/campaign/summary_json.h"

namespace stagger::server::campaign {
namespace {

std::uint64_t key_of(const Record& record) {
  return hash_text(record.values, mixed(record.repeat));
}

/// Trials by what they are: 16 bytes a trial, whatever else they hold.
class Index {
 public:
  explicit Index(const Store& store) {
    store.for_each(
        [this](const Record& record) { keys_.emplace_back(key_of(record), record.number); });
    std::sort(keys_.begin(), keys_.end());
  }
  std::optional<std::uint64_t> number(const Record& record) const {
    const std::pair<std::uint64_t, std::uint64_t> least(key_of(record), 0);
    const auto found = std::lower_bound(keys_.begin(), keys_.end(), least);
    if (found == keys_.end() || found->first != least.first) return std::nullopt;
    return found->second;
  }

 private:
  std::vector<std::pair<std::uint64_t, std::uint64_t>> keys_;
};

struct Measure {
  std::string name;
  std::optional<double> (*of)(const Record&);
};

const std::array<Measure, 3>& measures() {
  static const std::array<Measure, 3> list{
      {{"steps_to_recover",
        [](const Record& record) {
          const auto& steps = record.result.steps_to_recover;
          return steps ? std::optional(static_cast<double>(*steps)) : std::nullopt;
        }},
       {"recovery_time_s", [](const Record& record) { return record.result.recovery_time_s; }},
       {"worst_dcm_error_m",
        [](const Record& record) { return std::optional(record.result.worst_dcm_error_m); }}}};
  return list;
}

/// Goes over the pairs.
class Comparer {
 public:
  Comparer(const Plan& plan_b, const Store& a, const Store& b) : a_(a), b_(b) {
    result_.groups.emplace_back();
    for (const Entry& entry : plan_b.spec().design.entries) add_group("name", entry.name);
    for (const Factor& factor : plan_b.spec().factors) {
      for (const nlohmann::json& value : factor.values) add_group(factor.path, value);
    }
  }

  CampaignComparison run() {
    const Index index(a_);
    std::uint64_t of_a = a_.count();
    b_.for_each([&](const Record& in_b) {
      const auto number = index.number(in_b);
      const auto in_a = number ? a_.find(*number) : std::nullopt;
      if (!in_a || verdict_of(*in_a) == Verdict::undecided ||
          verdict_of(in_b) == Verdict::undecided) {
        ++result_.only_b;
        return;
      }
      --of_a;
      take(*in_a, in_b);
    });
    result_.only_a = of_a;
    result_.pairs = result_.groups.front().failures.pairs();
    for (PairedGroup& group : result_.groups) group.difference = paired_difference(group.failures);
    for (std::size_t i = 0; i < measures().size(); ++i) {
      result_.measures.push_back({measures()[i].name, values_[i].size(), mean_of(values_[i])});
    }
    return std::move(result_);
  }

 private:
  void add_group(const std::string& path, const nlohmann::json& value) {
    const Json ordered = value;
    if (!groups_.emplace(std::pair(path, to_text(ordered)), result_.groups.size()).second) return;
    PairedGroup group;
    group.path = path;
    group.value = ordered;
    result_.groups.push_back(std::move(group));
  }

  static void count(PairedCounts& counts, bool fails_in_a, bool fails_in_b) {
    if (fails_in_a && fails_in_b) ++counts.both;
    if (fails_in_a && !fails_in_b) ++counts.only_a;
    if (!fails_in_a && fails_in_b) ++counts.only_b;
    if (!fails_in_a && !fails_in_b) ++counts.neither;
  }

  void take(const Record& in_a, const Record& in_b) {
    count(result_.groups.front().failures, !in_a.passed, !in_b.passed);
    const Json values = Json::parse(in_b.values);
    for (const auto& [path, value] : values.items()) {
      const auto found = groups_.find({path, to_text(value)});
      if (found == groups_.end()) continue;
      count(result_.groups[found->second].failures, !in_a.passed, !in_b.passed);
    }
    constexpr std::size_t most_named = 1000;
    if (in_a.passed && !in_b.passed && result_.worse.size() < most_named) {
      result_.worse.push_back(in_b.number);
    }
    if (!in_a.passed || !in_b.passed) return;
    for (std::size_t i = 0; i < measures().size(); ++i) {
      const auto of_a = measures()[i].of(in_a);
      const auto of_b = measures()[i].of(in_b);
      if (of_a && of_b) values_[i].push_back(*of_b - *of_a);
    }
  }

  const Store& a_;
  const Store& b_;
  CampaignComparison result_;
  std::map<std::pair<std::string, std::string>, std::size_t> groups_;
  std::array<std::vector<double>, 3> values_;
};

void compare_limits(const Plan& plan_a, const Store& a, const Plan& plan_b, const Store& b,
                    CampaignComparison& result) {
  if (!plan_a.design().is_bisection() || !plan_b.design().is_bisection()) return;
  if (plan_a.spec().design.bisection.axis != plan_b.spec().design.bisection.axis) return;
  const auto is_known = [](const CellLimit& limit) {
    return limit.limit.done && !limit.limit.undecided;
  };
  std::map<std::string, double> of_a;
  for (const CellLimit& limit : limits_of(plan_a, a)) {
    if (is_known(limit)) of_a[to_text(limit.values)] = limit.pass.value_or(0.0);
  }
  std::vector<double> changes;
  for (const CellLimit& limit : limits_of(plan_b, b)) {
    const auto found = of_a.find(to_text(limit.values));
    if (found == of_a.end() || !is_known(limit)) continue;
    result.limits.push_back({limit.values, found->second, limit.pass.value_or(0.0)});
    if (found->second > 0.0) {
      changes.push_back((result.limits.back().b - found->second) / found->second);
    }
  }
  result.limit_change = mean_of(changes);
}

std::string percent(double share) {
  std::ostringstream text;
  text.precision(3);
  text << 100.0 * share << " %";
  return text.str();
}

void judge(const Tolerance& tolerance, CampaignComparison& result) {
  for (const PairedGroup& group : result.groups) {
    if (!group.difference) continue;
    const bool all = group.path.empty();
    const double growth = all ? group.difference->value : group.difference->low;
    if (!(growth > tolerance.failures)) continue;
    result.regressions.push_back(
        (all ? std::string("all trials") : group.path + " = " + to_text(group.value)) + ": " +
        percent(group.difference->value) + " more do not pass (95 % interval " +
        percent(group.difference->low) + " to " + percent(group.difference->high) +
        "); tolerated: " + percent(tolerance.failures));
  }
  if (result.limit_change && -result.limit_change->value > tolerance.limit) {
    result.regressions.push_back("the limits are " + percent(-result.limit_change->value) +
                                 " lower on the mean; tolerated: " + percent(tolerance.limit));
  }
}

}  // namespace

CampaignComparison compare(const Plan& plan_a, const Store& a, const Plan& plan_b, const Store& b,
                           const Tolerance& tolerance) {
  CampaignComparison result = Comparer(plan_b, a, b).run();
  compare_limits(plan_a, a, plan_b, b, result);
  judge(tolerance, result);
  return result;
}

Json comparison_json(const CampaignComparison& comparison) {
  Json json{{"pairs", comparison.pairs},
            {"only_a", comparison.only_a},
            {"only_b", comparison.only_b},
            {"groups", Json::array()},
            {"measures", Json::array()},
            {"limits", Json::array()},
            {"limit_change", estimate_json(comparison.limit_change)},
            {"worse", comparison.worse},
            {"regressions", comparison.regressions}};
  for (const PairedGroup& group : comparison.groups) {
    json["groups"].push_back({{"path", group.path},
                              {"value", group.value},
                              {"pairs", group.failures.pairs()},
                              {"fail_in_both", group.failures.both},
                              {"fail_in_a", group.failures.only_a},
                              {"fail_in_b", group.failures.only_b},
                              {"difference", estimate_json(group.difference)}});
  }
  for (const PairedMeasure& measure : comparison.measures) {
    json["measures"].push_back({{"name", measure.name},
                                {"pairs", measure.pairs},
                                {"difference", estimate_json(measure.difference)}});
  }
  for (const PairedLimit& limit : comparison.limits) {
    json["limits"].push_back({{"values", limit.values}, {"a", limit.a}, {"b", limit.b}});
  }
  return json;
}

}  // namespace stagger::server::campaign
