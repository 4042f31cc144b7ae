#include "server/campaign/plan_check.h"

#include <algorithm>

namespace stagger::server::campaign {
namespace {

using nlohmann::json;

/// Every trial is looked at when there are not more than this.
constexpr std::uint64_t few_trials = 5'000;

bool begins_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0 &&
         (text.size() == start.size() || text[start.size()] == '/');
}

class Checker {
 public:
  Checker(const Plan& plan, sim::JsonErrors& errors)
      : plan_(plan), spec_(plan.spec()), errors_(errors) {}

  void check() {
    check_count();
    check_name_of_factors();
    if (!errors_.empty()) return;
    try_values();
    if (!errors_.empty()) return;
    try_all();
    check_thresholds();
  }

 private:
  void check_count() {
    const std::uint64_t most = plan_.design().most_trials();
    if (most <= spec_.max_trials) return;
    errors_.add("/design", "can need " + std::to_string(most) + " trials; allowed by max_trials: " +
                               std::to_string(spec_.max_trials));
  }

  void check_name_of_factors() {
    if (spec_.design.kind != DesignKind::list) return;
    for (const Factor& factor : spec_.factors) {
      if (factor.path == "name") errors_.add("/factors/name", "is what the entries have already");
    }
  }

  /// Each value of each factor and each entry, the others being the first of theirs.
  void try_values() {
    if (spec_.design.kind == DesignKind::random) return;
    const auto first = plan_.design().settings({});
    try_settings(first, "");
    if (!errors_.empty()) return;
    for (const Factor& factor : spec_.factors) {
      const std::string place = "/factors/" + factor.path;
      for (std::size_t i = 1; i < factor.values.size(); ++i) {
        std::vector<Setting> settings = first;
        for (Setting& setting : settings) {
          if (setting.first == factor.path) setting.second = factor.values[i];
        }
        try_settings(settings, factor.listed ? place + "/" + std::to_string(i) : place);
      }
    }
    if (plan_.design().is_bisection()) {
      std::vector<Setting> settings = first;
      settings.back().second = spec_.design.bisection.hi;
      try_settings(settings, "/design/hi");
    }
    const std::size_t per_entry =
        plan_.design().cells() / std::max<std::size_t>(spec_.design.entries.size(), 1);
    for (std::size_t i = 1; i < spec_.design.entries.size(); ++i) {
      try_settings(plan_.design().settings({i * per_entry, 0, 0}), entry_place(i), i);
    }
  }

  void try_all() {
    const Design& design = plan_.design();
    const std::uint64_t count = std::min(design.numbers(), few_trials);
    for (std::uint64_t i = 0; i < count; ++i) {
      // All of them, or as many spread over all.
      const std::uint64_t number =
          design.numbers() <= few_trials ? i : i * (design.numbers() / few_trials);
      const PlannedTrial trial = plan_.trial(number);
      if (trial.refused.empty()) continue;
      errors_.add("/design", "makes trial " + std::to_string(number) + ", " +
                                 to_text(trial.values) + ", which cannot be: " + trial.refused);
      return;
    }
  }

  static std::string entry_place(std::size_t entry) {
    return "/design/trials/" + std::to_string(entry) + "/set";
  }

  /// `blamed`: the place of the value that is tried; empty: all of them.
  void try_settings(const std::vector<Setting>& settings, const std::string& blamed,
                    std::size_t entry = 0) {
    sim::JsonErrors found;
    const json body = plan_.assembled(settings, 0, found);
    plan_.read(body, found);
    for (const sim::JsonError& error : found.list()) {
      errors_.add(blamed.empty() || blamed == entry_place(entry)
                      ? place_of(error.pointer, settings, entry)
                      : blamed,
                  (blamed.empty() ? "" : error.pointer + " ") + error.text);
    }
  }

  /// Where in the specification the field at that pointer into a trial is set.
  std::string place_of(const std::string& pointer, const std::vector<Setting>& settings,
                       std::size_t entry) const {
    // The last that sets it counts.
    for (auto setting = settings.rbegin(); setting != settings.rend(); ++setting) {
      const std::string field = path_pointer(setting->first);
      if (!begins_with(pointer, field)) continue;
      const std::string rest = pointer.substr(field.size());
      if (plan_.design().is_bisection() && setting == settings.rbegin()) return "/design/lo";
      for (const Factor& factor : spec_.factors) {
        if (factor.path != setting->first) continue;
        return "/factors/" + factor.path + (factor.listed ? "/0" + rest : "");
      }
      return entry_place(entry) + "/" + setting->first + rest;
    }
    return "/base" + pointer;
  }

  void check_thresholds() {
    const auto settings = plan_.design().settings({});
    const PlannedTrial first = plan_.trial(0);
    for (std::size_t i = 0; i < spec_.thresholds.size(); ++i) {
      for (const Condition& condition : spec_.thresholds[i].conditions) {
        const bool known = condition.path == "repeat" || push_figure(condition.path, {}) ||
                           std::any_of(settings.begin(), settings.end(),
                                       [&](const Setting& s) { return s.first == condition.path; });
        if (known || first.resolved.contains(Json::json_pointer(path_pointer(condition.path)))) {
          continue;
        }
        errors_.add("/thresholds/" + std::to_string(i),
                    "asks for " + condition.path +
                        "; allowed: a factor, the axis, name, repeat, push.impulse_ns, "
                        "push.delta_v, push.fr, or another field of the trial");
      }
    }
  }

  const Plan& plan_;
  const CampaignSpec& spec_;
  sim::JsonErrors& errors_;
};

}  // namespace

void check_plan(const Plan& plan, sim::JsonErrors& errors) { Checker(plan, errors).check(); }

}  // namespace stagger::server::campaign
