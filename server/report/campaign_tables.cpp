#include "server/report/campaign_tables.h"

#include "server/json/trial_json.h"
#include "server/report/campaign_labels.h"
#include "server/report/campaign_report.h"
#include "server/report/published_pushes.h"
#include "server/report/scale.h"
#include "server/shell_word.h"

namespace stagger::server {
namespace {

std::string number_or_dash(const std::optional<double>& value, int decimals) {
  return value ? fixed(*value, decimals) : "–";
}

/// "83 % (44 to 97)".
std::string share_words(const std::optional<campaign::Estimate>& share) {
  if (!share) return "–";
  return fixed(100.0 * share->value, 0) + " % (" + fixed(100.0 * share->low, 0) + " to " +
         fixed(100.0 * share->high, 0) + ")";
}

std::string limit_remark(const campaign::CellLimit& found) {
  if (found.limit.undecided) return "undecided: a trial says nothing";
  if (!found.limit.done) return "not finished";
  if (!found.fail) return "all levels pass";
  if (!found.pass) return "below the lowest level";
  if (!found.limit.monotone) {
    return "not monotone: passes at " + flat_words(*found.highest_pass) + " too";
  }
  return "";
}

std::string_view words_of(PushSide side) {
  switch (side) {
    case PushSide::forward:
      return "forward";
    case PushSide::diagonal:
      return "forward and outward";
    case PushSide::outward:
      return "outward";
    case PushSide::back:
      return "back";
    case PushSide::inward:
      return "inward";
  }
  return "";
}

}  // namespace

std::string trial_anchor(std::uint64_t number) { return "trial-" + std::to_string(number); }

Table thresholds_table(const campaign::Summary& summary) {
  Table table;
  table.caption = "Thresholds";
  table.compact = true;
  table.columns = {{"What has to come out", false, true}, {"Value", true}, {"Result", false}};
  for (const campaign::ThresholdResult& result : summary.thresholds) {
    table.rows.push_back({{result.text, result.value ? significant(*result.value, 4) : "not known",
                           result.passed ? "holds" : "FAILED"}});
  }
  return table;
}

Table groups_table(const campaign::Summary& summary) {
  Table table;
  table.caption =
      "Trials by what was set, over all else. Pass rate and fall rate are of the trials that "
      "recovered or fell, with 95 % intervals (Wilson). In a bisection most trials are near the "
      "limit: these rates compare nothing there.";
  table.columns = {{"Value", false}, {"Trials", true},    {"Recovered", true},
                   {"Fell", true},   {"Time-out", true},  {"Invalid", true},
                   {"Passed", true}, {"Pass rate", true}, {"Fall rate", true}};
  const auto row = [](const std::string& name, const campaign::Counts& counts) {
    return Table::Row{
        {name, std::to_string(counts.trials), std::to_string(counts.recovered),
         std::to_string(counts.fell), std::to_string(counts.timeout),
         std::to_string(counts.invalid), std::to_string(counts.passed),
         share_words(campaign::share_of(counts.passed, counts.recovered + counts.fell)),
         share_words(campaign::fall_rate(counts))}};
  };
  table.rows.push_back(row("All", summary.counts));
  std::string path;
  for (const campaign::Group& group : summary.groups) {
    if (group.path != path) table.rows.push_back({{path_words(group.path)}, true});
    path = group.path;
    table.rows.push_back(row(value_words(path, group.value), group.counts));
  }
  return table;
}

Table limits_table(const campaign::Plan& plan, const campaign::Summary& summary) {
  const std::string unit = path_words(plan.spec().design.bisection.axis);
  Table table;
  table.caption = "The greatest level of " + unit +
                  " at which all repeats pass, below the lowest at which one fails. The ceiling is "
                  "that of the pendulum model with the same feet and steps.";
  table.columns = {{"Push", false},  {"Passes", true},   {"Fails", true}, {"N s", true},
                   {"N", true},      {"Δv (m/s)", true}, {"Fr", true},    {"% of ceiling", true},
                   {"Trials", true}, {"Remark", false}};
  for (const campaign::CellLimit& found : summary.limits) {
    const auto figure = [&](double campaign::PushFigures::*member) {
      return found.at_pass ? std::optional((*found.at_pass).*member) : std::nullopt;
    };
    const auto level = [](const std::optional<double>& value) {
      return value ? flat_words(*value) : "–";
    };
    const auto dv = figure(&campaign::PushFigures::delta_v);
    const bool known = dv && found.ceiling_dv && *found.ceiling_dv > 0.0;
    table.rows.push_back(
        {{found.values.empty() ? "All" : values_words(found.values), level(found.pass),
          level(found.fail), number_or_dash(figure(&campaign::PushFigures::impulse_ns), 1),
          number_or_dash(figure(&campaign::PushFigures::force_n), 0), number_or_dash(dv, 3),
          number_or_dash(figure(&campaign::PushFigures::fr), 3),
          known ? fixed(100.0 * *dv / *found.ceiling_dv, 0) : "–",
          std::to_string(found.limit.trials), limit_remark(found)}});
  }
  return table;
}

Table published_table() {
  Table table;
  table.caption =
      "What others have published. Outward is towards the foot that swings, inward towards the "
      "foot that stands. The conditions differ from ours and from one another: these are marks to "
      "read our numbers against, no ranking.";
  table.columns = {
      {"Who", false}, {"Push", false}, {"Δv (m/s)", true}, {"Fr", true}, {"Conditions", false}};
  for (const PublishedPush& push : published_pushes) {
    table.rows.push_back(
        {{std::string(push.who), std::string(words_of(push.side)), fixed(push.delta_v, 2),
          fixed(push.fr, 3), std::string(push.conditions)}});
  }
  return table;
}

FailedTrials failed_trials(const campaign::Store& store, const std::string& folder) {
  FailedTrials failed;
  // A path, whatever it begins with.
  const std::string place = shell_word(folder.starts_with('-') ? "./" + folder : folder);
  failed.table.columns = {{"Trial", true},           {"What was set", false},
                          {"Repeat", true},          {"End", false},
                          {"Pushed by (N s)", true}, {"Run it again", false, true}};
  store.for_each([&](const campaign::Record& record) {
    if (record.passed) return;
    if (++failed.count > most_listed_trials) return;
    failed.listed.insert(record.number);
    const sim::TrialResult& result = record.result;
    std::string end(name_of(result.outcome));
    if (result.outcome == sim::TrialOutcome::recovered) end = "was not back in time";
    if (!result.reason.empty()) end += ": " + result.reason;
    if (result.fall_time_s) end += ", at " + fixed(*result.fall_time_s, 2) + " s";
    failed.table.rows.push_back(
        {{std::to_string(record.number), values_words(Json::parse(record.values)),
          std::to_string(record.repeat), end, fixed(result.delivered_ns, 2),
          "stagger campaign trial " + place + " " + std::to_string(record.number) +
              " | stagger trial -"},
         false,
         trial_anchor(record.number)});
  });
  failed.table.caption = std::to_string(failed.count) +
                         " trials did not pass. Each command runs "
                         "one again, to the bit, from the folder that holds the campaign.";
  if (failed.count > most_listed_trials) {
    failed.table.caption += " Here are the first " + std::to_string(most_listed_trials) +
                            "; trials.csv has all of them.";
  }
  return failed;
}

}  // namespace stagger::server
