#include "server/report/campaign_report.h"

#include <algorithm>
#include <cctype>

#include "server/campaign/summary_json.h"
#include "server/report/campaign_labels.h"
#include "server/report/campaign_plots.h"
#include "server/report/campaign_polar.h"
#include "server/report/campaign_tables.h"
#include "server/report/html_page.h"
#include "server/report/scale.h"

namespace stagger::server {
namespace {

using campaign::DesignKind;
using campaign::Plan;
using campaign::Store;
using campaign::Summary;

/// On A4, or over both columns of a paper, text of 12 px is of 7 points then [px].
constexpr double figure_width = 800.0;

std::string design_words(const Plan& plan) {
  const campaign::DesignSpec& design = plan.spec().design;
  std::string text;
  switch (design.kind) {
    case DesignKind::grid:
      text = "grid: every combination of the factors";
      break;
    case DesignKind::list:
      text = "list of " + std::to_string(design.entries.size()) + " scenarios";
      break;
    case DesignKind::random:
      text = "random: " + std::to_string(design.samples) + " samples of the factors";
      break;
    case DesignKind::bisect: {
      const campaign::Bisection& axis = design.bisection;
      text = "bisection of " + path_words(axis.axis) + ", " + flat_words(axis.lo) + " to " +
             flat_words(axis.hi) + " by " + flat_words(axis.tol);
      break;
    }
  }
  return text + ", " + std::to_string(design.repeats) +
         (design.repeats == 1 ? " repeat" : " repeats");
}

std::string robot_words(const sim::Robot& robot) {
  return robot.name + " (" + fixed(robot.model.mass(), 1) + " kg, CoM " +
         fixed(robot.description.walk.com_height_m, 2) + " m high while walking)";
}

std::string robots_words(const Plan& plan) {
  std::vector<std::string> names;
  if (plan.spec().base.contains("robot")) names.push_back(flat_words(plan.spec().base["robot"]));
  for (const campaign::Factor& factor : plan.spec().factors) {
    if (factor.path != "robot") continue;
    names.clear();
    for (const auto& name : factor.values) names.push_back(flat_words(name));
  }
  std::string text;
  for (const std::string& name : names) {
    const auto robot = plan.robot(name);
    text += (text.empty() ? "" : "; ") + (robot ? robot_words(*robot) : name);
  }
  return text.empty() ? "see the specification" : text;
}

std::string varied_words(const Plan& plan) {
  std::string text;
  for (const VariedField& field : varied_fields(plan)) {
    text += (text.empty() ? "" : ", ") + path_words(field.path) + " × " +
            std::to_string(field.labels.size());
  }
  return text.empty() ? "nothing but the seed" : text;
}

std::string pass_words(const campaign::CampaignSpec& spec) {
  return spec.recover_within_s ? "it never falls, and is back at its gait within " +
                                     flat_words(*spec.recover_within_s) + " s of the push"
                               : "it is up at the end of the observation";
}

std::string counts_words(const Summary& summary) {
  const campaign::Counts& counts = summary.counts;
  return std::to_string(counts.trials) + ": " + std::to_string(counts.passed) + " passed, " +
         std::to_string(counts.recovered - counts.passed) + " were not back in time, " +
         std::to_string(counts.fell) + " fell, " + std::to_string(counts.timeout) + " timed out, " +
         std::to_string(counts.invalid) + " invalid";
}

/// What the pushes of all trials have in common.
std::string shared_push_words(const Plan& plan) {
  const Json resolved = plan.trial(0).resolved;
  if (!resolved.is_object() || !resolved.contains("push")) return "";
  Json push = resolved["push"];
  Json trigger = push.value("trigger", Json::object());
  push.erase("direction");  // as a vector
  const auto drop = [&](const std::string& path) {
    const std::vector<std::string> steps = campaign::path_steps(path);
    if (steps.front() != "push") return;
    if (steps.size() == 1) push.clear();
    if (steps.size() == 2) push.erase(steps[1]);
    if (steps.size() == 1 || path == "push.trigger") trigger.clear();
    if (steps.size() == 3) trigger.erase(steps[2]);
    if (is_hardness(path)) push.erase("impulse_ns");
  };
  for (const VariedField& field : varied_fields(plan)) drop(field.path);
  for (const campaign::Entry& entry : plan.spec().design.entries) {
    for (const auto& [path, value] : entry.settings) drop(path);
  }
  push.erase("trigger");
  if (!trigger.empty()) push["moment"] = value_words("push.trigger", trigger);
  return push.empty() ? "" : flat_words(push);
}

std::vector<std::pair<std::string, std::string>> facts_of(const Plan& plan, const Store& store,
                                                          const Summary& summary) {
  std::vector<std::pair<std::string, std::string>> facts{
      {"Version", "stagger " + store.version() + ", campaign seed " +
                      std::to_string(plan.spec().seed) + ", results " + summary.results_hash},
      {"Robot", robots_words(plan)},
      {"Design", design_words(plan)},
      {"Varied", varied_words(plan)},
      {"A trial passes when", pass_words(plan.spec())},
      {"Trials", counts_words(summary)},
      {"Repeatability", std::to_string(summary.counts.twice) + " run twice, " +
                            (summary.mismatches.empty()
                                 ? std::string("all the same to the bit")
                                 : std::to_string(summary.mismatches.size()) + " NOT THE SAME")}};
  // What all trials share, as the trial's specification has it.
  if (const std::string push = shared_push_words(plan); !push.empty()) {
    facts.emplace_back("Push", push);
  }
  std::string rest;
  const Json conditions = conditions_json(plan)["trial"];
  if (!conditions.is_object()) return facts;
  for (const auto& [name, value] : conditions.items()) {
    if (name == "robot" || name == "push") continue;
    if (value.is_object() && !value.empty()) {
      facts.emplace_back(static_cast<char>(std::toupper(name.front())) + name.substr(1),
                         flat_words(value));
    } else {
      rest += (rest.empty() ? "" : ", ") + name + " " + flat_words(value);
    }
  }
  if (!rest.empty()) facts.emplace_back("All trials", rest);
  return facts;
}

/// What must not be overlooked.
std::vector<Block> notices_of(const Summary& summary) {
  std::vector<Block> blocks;
  if (summary.state == campaign::State::invalid) {
    blocks.emplace_back(Paragraph{
        "THIS CAMPAIGN IS INVALID: trials that were run twice gave two results. Nothing here is "
        "to be trusted."});
  } else if (summary.state == campaign::State::incomplete) {
    blocks.emplace_back(Paragraph{"This campaign is not complete: trials are left to run."});
  }
  if (!summary.thresholds.empty()) blocks.emplace_back(thresholds_table(summary));
  return blocks;
}

Section limits_section(const Plan& plan, const Summary& summary) {
  Section section{"limits", "Push limits", {}};
  std::vector<PolarPanel> panels = polar_panels(plan, summary.limits);
  if (!panels.empty()) {
    const bool more = panels.size() > SurvivalMap::most_panels;
    if (more) panels.resize(SurvivalMap::most_panels);
    const double reach = polar_reach(panels);
    constexpr int columns = 2;
    std::vector<Plot> plots;
    plots.reserve(panels.size());
    for (const PolarPanel& panel : panels) {
      plots.push_back(polar_plot(panel, reach, picture_width(columns, figure_width),
                                 "polar-" + std::to_string(plots.size())));
    }
    section.blocks.emplace_back(Figure{
        "figure-limits",
        "Push limits in Fr = Δv / √(g h), by the moment of the push; 0° is forward, 90° to the "
        "robot's left, the moments name the foot that stands. Red: what no controller of the "
        "pendulum model can exceed; where it leaves the picture its value stands at the sides. "
        "Grey and black arcs: published marks at their directions, under conditions of their own "
        "(table below). The thin ring leads from one threshold of IHMC's to the next; those to the "
        "side, and the ring, stand only where one foot is known to swing." +
            std::string(more ? " More moments are in the table." : ""),
        columns, std::move(plots), true});
  }
  return section;
}

struct Axes {
  VariedField x;
  VariedField y;
};

/// What a survival map is drawn over: directions and how hard the push is, if they vary.
Axes axes_of(const Plan& plan) {
  std::vector<VariedField> fields = varied_fields(plan);
  const auto take = [&fields](const auto& is_wanted) {
    VariedField taken;
    const auto found = std::find_if(fields.begin(), fields.end(), is_wanted);
    if (found == fields.end()) return taken;
    taken = *found;
    fields.erase(found);
    return taken;
  };
  const std::string axis = plan.design().is_bisection() ? plan.spec().design.bisection.axis : "";
  const auto named = [](const std::string& name) {
    return [name](const VariedField& field) { return field.path == name; };
  };
  const auto hardness = [](const VariedField& field) { return is_hardness(field.path); };
  Axes axes;
  axes.y = take(named(axis));
  if (axes.y.path.empty()) axes.y = take(hardness);
  axes.x = take(named("push.direction_deg"));
  if (axes.y.path.empty()) axes.y = take(named("name"));
  if (axes.y.path.empty()) std::swap(axes.x, axes.y);
  const auto any = [](const VariedField&) { return true; };
  if (axes.y.path.empty()) axes.y = take(any);
  // A list's scenarios stand alone: what varies beside them are colours.
  if (axes.x.path.empty() && axes.y.path != "name") axes.x = take(any);
  return axes;
}

Section survival_section(const Plan& plan, const Store& store, const TrialLink& link) {
  Section section{"survival", "Survival", {}};
  const Axes axes = axes_of(plan);
  if (axes.y.path.empty()) return section;
  const SurvivalMap map = survival_map(plan, store, axes.x, axes.y);
  const std::string more = map.has_more ? " Combinations beyond the first " +
                                              std::to_string(SurvivalMap::most_panels) +
                                              " are in trials.csv alone."
                                        : "";
  if (axes.x.path.empty() && map.panels.size() <= 5) {
    section.blocks.emplace_back(
        Figure{"figure-survival",
               "Share of trials that pass, with 95 % intervals (Wilson)." + more,
               1,
               {survival_rows(map, figure_width, "rows")}});
    return section;
  }
  const int columns = map.panels.size() == 1 ? 1 : 2;
  Figure figure{"figure-survival",
                "Trials that pass of those that were run, and the 95 % interval of that share "
                "(Wilson); direction 0° is forward, 90° to the robot's left. Blue: all pass; red: "
                "some fail, the deeper the more. White: not run. A cell with a failure leads to "
                "its first failed trial." +
                    more,
                columns,
                {},
                true};
  for (const SurvivalMap::Panel& panel : map.panels) {
    figure.plots.push_back(heat_map(map, panel, link, picture_width(columns, figure_width),
                                    "map-" + std::to_string(figure.plots.size())));
  }
  section.blocks.emplace_back(std::move(figure));
  return section;
}

/// Nothing when the campaign does not vary the strategies.
std::vector<Section> ablation_section(const Plan& plan, const Store& store) {
  VariedField strategies;
  VariedField hardness;
  for (VariedField& field : varied_fields(plan)) {
    if (field.path == "strategies") strategies = field;
    if (is_hardness(field.path)) hardness = field;
  }
  if (strategies.path.empty()) return {};
  Section section{"ablation", "Strategies", {}};
  if (plan.design().is_bisection()) {
    section.blocks.emplace_back(Paragraph{
        "Limits by strategy are the lines of the first figure, and in the table of limits."});
    return {std::move(section)};
  }
  const double width = picture_width(2, figure_width);
  Figure figure{"figure-ablation",
                "Share of trials that pass for each set of strategies, over how hard the push is "
                "and over all pushes, with 95 % intervals (Wilson). All else that varies is taken "
                "together.",
                2,
                {}};
  if (!hardness.path.empty()) {
    const SurvivalMap map = survival_map(plan, store, hardness, strategies, true);
    figure.plots.push_back(survival_curves(map, width, "ablation"));
    figure.plots.back().title = "By how hard the push is";
  }
  const SurvivalMap all = survival_map(plan, store, {}, strategies, true);
  figure.plots.push_back(survival_rows(all, width, "strategies"));
  figure.plots.back().title = "Over all pushes";
  section.blocks.emplace_back(std::move(figure));
  return {std::move(section)};
}

/// All with figures.
std::vector<Section> results_of(const Plan& plan, const Store& store, const Summary& summary,
                                const TrialLink& link) {
  std::vector<Section> sections;
  if (plan.design().is_bisection()) sections.push_back(limits_section(plan, summary));
  sections.push_back(survival_section(plan, store, link));
  sections.back().blocks.emplace_back(groups_table(summary));
  for (Section& section : ablation_section(plan, store)) sections.push_back(std::move(section));
  if (plan.design().is_bisection()) {
    sections.push_back({"numbers", "Limits in numbers", {limits_table(plan, summary)}});
  }
  return sections;
}

/// For those who meet a figure outside of its page.
std::string figure_note(const Plan& plan, const Store& store, const Summary& summary) {
  std::string note = plan.spec().name;
  for (const auto& [name, value] : facts_of(plan, store, summary)) {
    if (name == "Varied" || name == "Trials" || name == "Repeatability") continue;
    note.append(". ").append(name).append(": ").append(value);
  }
  return note + ".";
}

}  // namespace

std::string campaign_report(const Plan& plan, const Store& store, const Summary& summary,
                            const std::string& folder) {
  FailedTrials failed = failed_trials(store, folder);
  const TrialLink link = [&failed](std::uint64_t number) {
    return failed.listed.contains(number) ? "#" + trial_anchor(number) : "";
  };
  Page page;
  page.title = plan.spec().name + ": push campaign";
  page.subtitle = "How hard can it be pushed? " + std::to_string(summary.counts.trials) +
                  " trials of " + robots_words(plan);
  page.facts = facts_of(plan, store, summary);
  page.summary = notices_of(summary);
  page.sections = results_of(plan, store, summary, link);
  page.sections.push_back({"published", "Beside others", {published_table()}});
  Section trials{"failed", "Trials that did not pass", {}};
  if (failed.count == 0) {
    trials.blocks.emplace_back(Paragraph{"None: all trials passed."});
  } else {
    trials.blocks.emplace_back(std::move(failed.table));
  }
  page.sections.push_back(std::move(trials));
  page.sections.push_back(
      {"specification",
       "Specification",
       {Paragraph{"Run it again: save this as campaign.json, then"},
        Verbatim{"stagger campaign run campaign.json"}, Verbatim{store.specification()}}});
  return to_html(page);
}

std::vector<FigureFile> campaign_figures(const Plan& plan, const Store& store,
                                         const Summary& summary) {
  const std::string note = figure_note(plan, store, summary);
  std::vector<FigureFile> files;
  for (const Section& section : results_of(plan, store, summary, {})) {
    for (const Block& block : section.blocks) {
      const auto* figure = std::get_if<Figure>(&block);
      if (figure != nullptr) files.push_back({section.id + ".svg", figure_file(*figure, note)});
    }
  }
  return files;
}

}  // namespace stagger::server
