#include "server/report/paper_report.h"

#include <cmath>

#include "server/report/html_page.h"
#include "server/report/paper_plots.h"
#include "server/report/paper_table.h"

namespace stagger::server {
namespace {

Table summary_table(const sim::PaperResults& results) {
  Table table;
  table.caption = "Every number, with what the paper publishes and what no controller can exceed";
  table.columns = {{"Number", false},     {"Unit", false},     {"Ours", true},
                   {"Under noise", true}, {"Published", true}, {"Ceiling", true},
                   {"Of ceiling", true}};
  for (const PaperGroup& group : paper_table(results)) {
    table.rows.push_back({{group.title}, true});
    for (const PaperRow& row : group.rows) {
      table.rows.push_back(
          {{row.name, row.unit, row.ours, row.noise, row.published, row.ceiling, row.percent},
           false});
    }
  }
  return table;
}

Table node_table(const sim::PlanResult& plan) {
  Table table;
  table.caption = "References at the ends of the phases, one axis; both are equal";
  table.compact = true;
  table.columns = {
      {"Time (s)", true}, {"CoM (m)", true}, {"CoM, independent (m)", true}, {"DCM (m)", true}};
  for (const sim::PlanNode& node : plan.nodes) {
    table.rows.push_back({{fixed(node.time, 1), fixed(node.com, 5), fixed(node.independent_com, 5),
                           fixed(node.dcm, 5)},
                          false});
  }
  return table;
}

Section plan_section(const sim::PlanResult& plan) {
  Figure figure{"figure-plan",
                "Planned references of six diagonal steps: step length 0.5 m in x and in y, single "
                "support 0.8 s, double support 0.2 s, swing height 25 mm. The ZMP stands under the "
                "foot in single "
                "support and moves to the next one in double support. Red dots come from a linear "
                "system for the boundary values, which shares nothing with the planner.",
                2, plan_plots(plan)};
  return {"plan", "Planner", {std::move(figure), node_table(plan)}};
}

Section tracking_section(const sim::TrackingResult& tracking) {
  Figure figure{
      "figure-lqg",
      "Six steps of 0.5 m forward, single support 1 s, no double support, with measurement "
      "noise of 25 mm standard deviation on CoM and DCM; the first of " +
          std::to_string(tracking.seeds) +
          " seeds. The band is the extent of the feet on the ground: no ZMP can lie "
          "outside.",
      2, tracking_plots(tracking)};
  return {"lqg", "LQG controller under noise", {std::move(figure)}};
}

std::string hip_title(const engine::HipParameters& hip) {
  return fixed(hip.torque, 0) + " N m, " + fixed(hip.inertia, 1) + " kg m², " +
         fixed(hip.angle, 1) + " rad";
}

std::string count_of(const sim::StandingResult& result) {
  return std::to_string(result.recovered) + " of " + std::to_string(result.bound);
}

Section standing_section(const sim::StandingFigures& figures) {
  const double wide = picture_width(2);
  const double narrow = picture_width(3);
  std::vector<Plot> ankle{
      standing_map(figures.ankle, wide, "scenario1-ankle", "Ankle: " + count_of(figures.ankle)),
      standing_map(figures.ankle_noise, wide, "scenario1-noise",
                   "Ankle under noise, worst of " + std::to_string(figures.noise_seeds) +
                       " seeds: " + count_of(figures.ankle_noise))};
  std::vector<Plot> hips;
  for (const sim::StandingResult& result : figures.hips) {
    hips.push_back(standing_map(result, narrow, "scenario1-hip-" + std::to_string(hips.size() + 1),
                                hip_title(result.setup.hip) + ": " + count_of(result)));
  }
  const auto example = [](const sim::StandingExample& e, const char* id, const char* fate) {
    return standing_example_plot(e, id,
                                 std::string(fate) + ": from " + fixed(e.position, 2) + " m and " +
                                     fixed(e.velocity, 1) + " m/s");
  };
  const std::vector<Plot> examples{example(figures.recovered, "scenario1-recovered", "Recovered"),
                                   example(figures.lost, "scenario1-lost", "Lost")};
  return {"scenario1",
          "Scenario 1: standing on one foot",
          {Figure{"figure-ankle",
                  "441 initial states of the CoM, and which of them are at rest after two seconds "
                  "(less than 1 cm and 3 cm/s off) and still up three seconds later. Between the "
                  "red lines |c + v/ω| is at most half the foot's length; beyond, no ankle helps.",
                  2, ankle},
           Figure{"figure-examples",
                  "Two neighbours on the grid, one on either side of the bound. The band is the "
                  "foot; with the ZMP at its edge and the DCM outside, the fall cannot be stopped.",
                  2, examples},
           Figure{"figure-hip",
                  "The same with a flywheel for the upper body, by torque, inertia and greatest "
                  "lean: the torque moves the bound outwards until the lean is used up.",
                  3, std::move(hips), true}}};
}

Table push_table(const sim::SteppingFigures& figures) {
  Table table;
  table.caption = "The paper's eight pushes, with our own settings and with those fitted to it";
  table.columns = {{"Push", false},
                   {"Strategies", false},
                   {"Published", false},
                   {"Our settings", false},
                   {"Fitted", false}};
  const auto lands = [](double metres) { return "lands at " + fixed(metres, 2) + " m"; };
  const auto changes = [](double seconds) { return "step " + fixed(seconds, 2) + " s"; };
  const auto published = [&](const sim::PublishedPush& push) -> std::string {
    if (push.fell) return "falls";
    if (push.landing) return lands(*push.landing);
    if (push.time_change) return changes(*push.time_change);
    return "recovers";
  };
  const auto ours = [&](const sim::PushComparison& push) -> std::string {
    if (push.ours.fell) return "falls";
    std::string text = lands(push.ours.landing);
    if (push.published.strategy == sim::SteppingStrategy::time) {
      text += ", " + changes(push.ours.time_change);
    }
    return text;
  };
  for (std::size_t i = 0; i < figures.pushes.size(); ++i) {
    const sim::PublishedPush& push = figures.pushes[i].published;
    table.rows.push_back({{fixed(push.force, 0) + " N", strategy_text(push.strategy),
                           published(push), ours(figures.pushes[i]), ours(figures.fit_pushes[i])},
                          false});
  }
  return table;
}

Figure push_figure(const std::vector<sim::PushComparison>& pushes, const std::string& id,
                   const std::string& settings) {
  std::vector<Plot> plots;
  plots.reserve(pushes.size());
  for (const sim::PushComparison& push : pushes) {
    plots.push_back(push_plot(push, picture_width(4), id + "-" + std::to_string(plots.size() + 1)));
  }
  // The same range for all, from those that recover: once lost, the rest of the way down says
  // nothing.
  std::vector<Layer> shown;
  for (std::size_t i = 0; i < plots.size(); ++i) {
    if (pushes[i].ours.fell) continue;
    shown.insert(shown.end(), plots[i].layers.begin(), plots[i].layers.end());
  }
  for (Plot& plot : plots) plot.y.range = padded(y_range(shown));
  return Figure{"figure-" + id,
                "The paper's eight pushes of 10 ms forward, " + settings +
                    ": CoM, DCM and ZMP along x. The band is where the ZMP can be; it "
                    "moves when the step lands.",
                4, std::move(plots), true};
}

Section stepping_section(const sim::SteppingFigures& figures) {
  Section section{"scenario2", "Scenario 2: pushed while stepping in place", {}};
  const int seeds = figures.limits.empty() ? 0 : figures.limits.front().noise_seeds;
  section.blocks.emplace_back(Figure{
      "figure-limits",
      "Push of 10 ms on the CoM during single support of the left foot. Bars: least force "
      "that leads to a fall, without noise. Thin lines: the same under noise of 25 mm standard "
      "deviation, " +
          std::to_string(seeds) +
          " seeds. Red: force that no controller survives with the same foot, reach and "
          "limits of the step time. What is left of single support decides the most.",
      1,
      {stepping_bars(figures.limits)}});
  if (figures.directions.empty()) return section;
  std::vector<Plot> plots;
  for (const sim::SteppingLimits& forward : figures.limits) {
    std::vector<sim::SteppingLimits> around{forward};
    for (const sim::SteppingLimits& l : figures.directions) {
      if (l.timing.t_ss == forward.timing.t_ss && l.timing.t_ds == forward.timing.t_ds &&
          l.timing.t_left == forward.timing.t_left) {
        around.push_back(l);
      }
    }
    plots.push_back(direction_plot(around, picture_width(3),
                                   "scenario2-directions-" + std::to_string(plots.size() + 1)));
  }
  section.blocks.emplace_back(Figure{
      "figure-directions",
      "First fall in eight directions, seen from above; the left foot stands. Titles: single "
      "support / double support / single support left at the push. Only the dots are "
      "measured, the lines between them guide the eye. Legs do not cross: pushes to the "
      "left find little room for a step.",
      3, std::move(plots), true});
  if (!figures.pushes.empty()) {
    section.blocks.emplace_back(push_table(figures));
    section.blocks.emplace_back(push_figure(figures.pushes, "pushes", "with our own settings"));
    section.blocks.emplace_back(
        push_figure(figures.fit_pushes, "fit-pushes", "with settings fitted to the paper"));
  }
  return section;
}

Section robustness_section(const std::vector<sim::RobustnessResult>& results) {
  Table table;
  table.caption =
      "First fall as a share of that without error, least over the five timings; states of "
      "scenario "
      "1 of those that the true robot could recover; falls without any push";
  table.columns = {{"True robot", false}, {"Ankle", true},          {"Ankle and place", true},
                   {"All three", true},   {"States at rest", true}, {"Falls unpushed", true}};
  for (const sim::RobustnessResult& result : results) {
    const auto share = [&](double sim::StrategyForces::*strategy) {
      return fixed(100.0 * least_share(result, results.front(), strategy), 0) + " %";
    };
    table.rows.push_back(
        {{error_text(result.error), share(&sim::StrategyForces::ankle),
          share(&sim::StrategyForces::location), share(&sim::StrategyForces::time),
          std::to_string(result.standing_recovered) + " of " +
              std::to_string(result.standing_bound),
          std::to_string(result.unpushed_falls) + " of " + std::to_string(result.unpushed_runs)},
         false});
  }
  return {"robustness",
          "Robustness: an engine that is wrong about its robot",
          {Paragraph{"The engine keeps its settings; the robot that it moves is another one."},
           std::move(table)}};
}

}  // namespace

std::string paper_report(const sim::PaperResults& results, const std::string& command) {
  Page page;
  page.title = "Push recovery of the walking engine, beside the paper";
  page.subtitle =
      "Kasaei, Lau and Pereira: A Hierarchical Framework to Generate Robust Biped Locomotion Based "
      "on Divergent Component of Motion, IROS 2019.";
  page.facts = {
      {"Robot", "linear inverted pendulum: 30 kg, CoM at 1 m, foot 0.15 m × 0.075 m"},
      {"Limits", "step up to 0.95 m, step time ± 0.2 s, no leg crosses the other"},
      {"Control", "500 Hz; noise, where there is any: 25 mm standard deviation on CoM and DCM"},
      {"Program", "stagger " STAGGER_VERSION},
      {"Command", command}};
  page.summary.emplace_back(summary_table(results));
  if (results.stepping) {
    page.summary.emplace_back(Paragraph{
        "The paper pushes forward, and gives no gait timing with its forces: its numbers stand "
        "beside every timing, as the greatest force survived and the one that falls. Forces under "
        "noise are medians; noise moves the robot before the push already, so that they can lie "
        "above the ceiling, which is that of the undisturbed gait."});
  }
  if (results.plan) page.sections.push_back(plan_section(*results.plan));
  if (results.tracking) page.sections.push_back(tracking_section(*results.tracking));
  if (results.standing) page.sections.push_back(standing_section(*results.standing));
  if (results.stepping) page.sections.push_back(stepping_section(*results.stepping));
  if (!results.robustness.empty()) {
    page.sections.push_back(robustness_section(results.robustness));
  }
  return to_html(page);
}

}  // namespace stagger::server
