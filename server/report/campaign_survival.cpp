#include "server/report/campaign_survival.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "server/report/campaign_labels.h"

namespace stagger::server {
namespace {

constexpr std::size_t most_levels = 40;
constexpr std::size_t bins = 12;

void add_label(VariedField& field, const Json& value) {
  std::string label = value_words(field.path, value);
  const auto known = std::find(field.labels.begin(), field.labels.end(), label);
  if (known == field.labels.end()) field.labels.push_back(std::move(label));
}

VariedField binned(const std::string& path, double from, double to) {
  VariedField field{path, {}, {}, (to - from) / static_cast<double>(bins)};
  for (std::size_t i = 0; i < bins; ++i) {
    field.numbers.push_back(from + field.bin * (static_cast<double>(i) + 0.5));
    field.labels.push_back(value_words(path, field.numbers.back()));
  }
  return field;
}

VariedField of_factor(const campaign::Factor& factor) {
  if (factor.interval) return binned(factor.path, factor.interval->lo, factor.interval->hi);
  VariedField field{factor.path, {}, {}};
  const bool numbers = std::all_of(factor.values.begin(), factor.values.end(),
                                   [](const auto& value) { return value.is_number(); });
  std::vector<nlohmann::json> values = factor.values;
  if (numbers) std::sort(values.begin(), values.end());
  for (const nlohmann::json& value : values) {
    const std::size_t before = field.labels.size();
    add_label(field, value);
    if (numbers && field.labels.size() > before) field.numbers.push_back(value.get<double>());
  }
  return field;
}

VariedField of_axis(const campaign::Plan& plan) {
  const campaign::Bisection& axis = plan.spec().design.bisection;
  const auto levels = static_cast<std::size_t>(std::llround((axis.hi - axis.lo) / axis.tol)) + 1;
  if (levels > most_levels) return binned(axis.axis, axis.lo, axis.hi);
  VariedField field{axis.axis, {}, {}};
  for (std::size_t i = 0; i < levels; ++i) {
    field.numbers.push_back(plan.design().level(i));
    field.labels.push_back(value_words(axis.axis, field.numbers.back()));
  }
  return field;
}

/// Finds the place of a trial's value among a field's labels.
class FieldIndex {
 public:
  explicit FieldIndex(const VariedField& field) : field_(field) {
    for (std::size_t i = 0; i < field.labels.size(); ++i) places_.emplace(field.labels[i], i);
  }
  std::optional<std::size_t> operator()(const Json& values) const {
    if (field_.path.empty()) return 0;
    const auto value = values.find(field_.path);
    if (value == values.end()) return std::nullopt;
    if (field_.bin > 0.0 && value->is_number()) {
      const double from = field_.numbers.front() - 0.5 * field_.bin;
      const double place = std::floor((value->get<double>() - from) / field_.bin);
      return static_cast<std::size_t>(
          std::clamp(place, 0.0, static_cast<double>(field_.labels.size() - 1)));
    }
    const auto found = places_.find(value_words(field_.path, *value));
    return found == places_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  const VariedField& field_;
  std::map<std::string, std::size_t> places_;
};

}  // namespace

bool is_hardness(const std::string& path) {
  for (const char* name : {"push.fr", "push.delta_v", "push.impulse_ns", "push.force_n"}) {
    if (path == name) return true;
  }
  return false;
}

std::vector<VariedField> varied_fields(const campaign::Plan& plan) {
  const campaign::CampaignSpec& spec = plan.spec();
  std::vector<VariedField> fields;
  if (!spec.design.entries.empty()) {
    VariedField names{"name", {}, {}};
    for (const campaign::Entry& entry : spec.design.entries) add_label(names, entry.name);
    fields.push_back(std::move(names));
  }
  for (const campaign::Factor& factor : spec.factors) fields.push_back(of_factor(factor));
  if (plan.design().is_bisection()) fields.push_back(of_axis(plan));
  std::erase_if(fields, [](const VariedField& field) { return field.labels.size() < 2; });
  return fields;
}

SurvivalMap survival_map(const campaign::Plan& plan, const campaign::Store& store,
                         const VariedField& x, const VariedField& y, bool pooled) {
  SurvivalMap map{x, y, {}};
  const FieldIndex column(map.x);
  const FieldIndex row(map.y);
  std::vector<std::string> others;
  for (const VariedField& field : varied_fields(plan)) {
    if (field.path != x.path && field.path != y.path) others.push_back(field.path);
  }
  std::map<std::string, std::size_t> known;
  store.for_each([&](const campaign::Record& record) {
    const campaign::Verdict verdict = verdict_of(record);
    if (verdict == campaign::Verdict::undecided) return;
    const Json values = Json::parse(record.values);
    Json rest = Json::object();
    for (const std::string& path : others) {
      // What has no end of values would have no end of panels.
      if (!pooled && values.contains(path)) rest[path] = values[path];
    }
    const std::string title = values_words(rest);
    auto panel = known.find(title);
    if (panel == known.end()) {
      if (map.panels.size() == SurvivalMap::most_panels) {
        map.has_more = true;
        return;
      }
      panel = known.emplace(title, map.panels.size()).first;
      map.panels.push_back({title, std::vector<Survival>(map.columns() * y.labels.size())});
    }
    const auto at_x = column(values);
    const auto at_y = row(values);
    if (!at_x || !at_y) return;
    Survival& cell = map.panels[panel->second].cells[*at_y * map.columns() + *at_x];
    if (verdict == campaign::Verdict::pass) {
      ++cell.passed;
    } else if (cell.failed++ == 0) {
      cell.first_failed = record.number;
    }
  });
  return map;
}

}  // namespace stagger::server
