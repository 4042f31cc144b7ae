#include "server/report/paper_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "server/report/html_page.h"
#include "server/report/paper_table.h"
#include "sim/experiment/paper/published.h"

namespace stagger::server {
namespace {

// One of so many ticks is drawn: 10 ms of 2 ms ticks.
constexpr std::size_t stride = 5;

// The same quantity looks the same in all figures: dark to light, thin to wide.
constexpr Stroke com_stroke{Ink::strong, 1.5};
constexpr Stroke dcm_stroke{Ink::measured, 1.5};
constexpr Stroke zmp_stroke{Ink::soft, 1.7};
constexpr Stroke reference_stroke{Ink::reference, 1.4, true};
constexpr Stroke bound_stroke{Ink::limit, 1.4};

constexpr std::array<Ink, 3> strategy_inks{Ink::soft, Ink::measured, Ink::strong};
constexpr std::array<const char*, 3> strategy_names{"ankle", "ankle and place",
                                                    "ankle, place and time"};

std::array<double, 3> by_strategy(const sim::StrategyForces& forces) {
  return {forces.ankle, forces.location, forces.time};
}

Eigen::Index index(GroundAxis axis) { return axis == GroundAxis::x ? 0 : 1; }
std::string name_of(GroundAxis axis) { return axis == GroundAxis::x ? "x" : "y"; }

using Value = std::function<double(const sim::TraceSample&)>;

std::vector<DataPoint> points_of(const sim::Trace& trace, const Value& value) {
  std::vector<DataPoint> points;
  for (std::size_t i = 0; i < trace.size(); i += stride) {
    points.push_back({trace[i].time, value(trace[i])});
  }
  return points;
}

Value reference_of(sim::TracedPoint sim::TraceSample::*point, GroundAxis axis) {
  return [=](const sim::TraceSample& s) { return (s.*point).reference(index(axis)); };
}
Value actual_of(sim::TracedPoint sim::TraceSample::*point, GroundAxis axis) {
  return [=](const sim::TraceSample& s) { return (s.*point).actual(index(axis)); };
}
Value error_of(sim::TracedPoint sim::TraceSample::*point, GroundAxis axis) {
  return [=](const sim::TraceSample& s) { return 1e3 * (s.*point).error()(index(axis)); };
}

Range times_of(const sim::Trace& trace) {
  if (trace.empty()) return {0.0, 1.0};
  return {trace.front().time, trace.back().time};
}

Plot footprint_plot(const sim::PlanResult& plan) {
  const engine::Parameters p = sim::paper_parameters();
  Plot plot;
  plot.id = "plan-footprints";
  plot.title = "Footprints from above";
  plot.description = "Seven footprints on a diagonal, with the references of ZMP, CoM and DCM.";
  plot.height = 430.0;
  plot.x.label = "x (m)";
  plot.y.label = "y (m)";
  plot.equal_aspect = true;
  for (const sim::Side side : {sim::Side::left, sim::Side::right}) {
    BoxLayer feet;
    feet.name = side == sim::Side::left ? "left foot" : "right foot";
    feet.fill = {side == sim::Side::left ? Ink::planned : Ink::reference, 0.25};
    feet.outlined = true;
    for (const engine::Footstep& step : plan.steps) {
      if (step.side != side) continue;
      const double x = step.position.x();
      const double y = step.position.y();
      feet.boxes.push_back({{x - p.foot_half_length, y - p.foot_half_width},
                            {x + p.foot_half_length, y + p.foot_half_width}});
    }
    plot.layers.emplace_back(std::move(feet));
  }
  LineLayer com{"CoM", com_stroke, {}};
  for (const sim::TraceSample& sample : plan.references) {
    com.points.push_back({sample.com.reference.x(), sample.com.reference.y()});
  }
  plot.layers.emplace_back(std::move(com));
  DotLayer nodes{"CoM at the phases' ends", {Ink::strong}, {}, 2.2};
  for (const sim::PlanNode& node : plan.nodes) nodes.points.push_back({node.com, node.com});
  plot.layers.emplace_back(std::move(nodes));
  return plot;
}

Plot swing_plot(const sim::PlanResult& plan) {
  Plot plot;
  plot.id = "plan-swings";
  plot.title = "Swing feet from the side";
  plot.description = "Height of the swing foot over its way forward, one arc for each step.";
  plot.height = 430.0;
  plot.x.label = "x (m)";
  plot.y.label = "z (mm)";
  plot.y.range = Range{-1.0, 30.0};
  for (std::size_t i = 0; i < plan.swings.size(); ++i) {
    const bool right = plan.steps[i + 1].side == sim::Side::right;
    LineLayer arc{
        right ? "right foot" : "left foot", {right ? Ink::reference : Ink::planned, 1.6}, {}};
    for (std::size_t k = 0; k < plan.swings[i].size(); k += stride) {
      const engine::Vec3& at = plan.swings[i][k].position;
      arc.points.push_back({at.x(), 1e3 * at.z()});
    }
    plot.layers.emplace_back(std::move(arc));
  }
  return plot;
}

Plot reference_plot(const sim::PlanResult& plan, GroundAxis axis) {
  Plot plot;
  plot.id = "plan-references-" + name_of(axis);
  plot.title = "References in " + name_of(axis);
  plot.description = "Planned ZMP, DCM and CoM over time.";
  plot.x.label = "time (s)";
  plot.x.range = times_of(plan.references);
  plot.y.label = name_of(axis) + " (m)";
  const auto line = [&](const char* name, const Stroke& stroke,
                        sim::TracedPoint sim::TraceSample::*point) {
    plot.layers.emplace_back(
        LineLayer{name, stroke, points_of(plan.references, reference_of(point, axis))});
  };
  line("ZMP", {Ink::soft, 2.4}, &sim::TraceSample::zmp);
  line("DCM", dcm_stroke, &sim::TraceSample::dcm);
  line("CoM", com_stroke, &sim::TraceSample::com);
  DotLayer independent{"CoM, independent solution", {Ink::limit}, {}, 2.2};
  for (const sim::PlanNode& node : plan.nodes) {
    independent.points.push_back({node.time, node.independent_com});
  }
  plot.layers.emplace_back(std::move(independent));
  return plot;
}

Plot error_plot(const sim::Trace& trace, GroundAxis axis) {
  Plot plot;
  plot.id = "lqg-error-" + name_of(axis);
  plot.title = "Error in " + name_of(axis);
  plot.description = "True CoM and DCM less their references, over time, in millimetres.";
  plot.height = 240.0;
  plot.x.label = "time (s)";
  plot.x.range = times_of(trace);
  plot.y.label = "error (mm)";
  plot.layers = {
      LineLayer{"DCM", dcm_stroke, points_of(trace, error_of(&sim::TraceSample::dcm, axis))},
      LineLayer{"CoM", com_stroke, points_of(trace, error_of(&sim::TraceSample::com, axis))}};
  return plot;
}

/// Line of c + v/w = dcm across the map.
LineLayer dcm_line(std::string name, const Stroke& stroke, double dcm, double omega) {
  constexpr double beyond = 0.3;
  return {std::move(name),
          stroke,
          {{-beyond, omega * (dcm + beyond)}, {beyond, omega * (dcm - beyond)}}};
}

}  // namespace

std::vector<Plot> plan_plots(const sim::PlanResult& plan) {
  return {footprint_plot(plan), swing_plot(plan), reference_plot(plan, GroundAxis::x),
          reference_plot(plan, GroundAxis::y)};
}

Plot trajectory_plot(const sim::Trace& trace, GroundAxis axis, std::string id, std::string title) {
  Plot plot;
  plot.id = std::move(id);
  plot.title = std::move(title);
  plot.description = "CoM and DCM over time, with their references dashed.";
  plot.x.label = "time (s)";
  plot.x.range = times_of(trace);
  plot.y.label = name_of(axis) + " (m)";
  const auto actual = [&](const char* name, const Stroke& stroke,
                          sim::TracedPoint sim::TraceSample::*point) {
    plot.layers.emplace_back(LineLayer{name, stroke, points_of(trace, actual_of(point, axis))});
  };
  const auto reference = [&](sim::TracedPoint sim::TraceSample::*point) {
    plot.layers.emplace_back(
        LineLayer{"reference", reference_stroke, points_of(trace, reference_of(point, axis))});
  };
  actual("DCM", dcm_stroke, &sim::TraceSample::dcm);
  actual("CoM", com_stroke, &sim::TraceSample::com);
  reference(&sim::TraceSample::dcm);
  reference(&sim::TraceSample::com);
  return plot;
}

Plot zmp_plot(const sim::Trace& trace, GroundAxis axis, std::string id, std::string title) {
  Plot plot;
  plot.id = std::move(id);
  plot.title = std::move(title);
  plot.description = "ZMP over time with its reference, between the edges of the feet that stand.";
  plot.x.label = "time (s)";
  plot.x.range = times_of(trace);
  plot.y.label = name_of(axis) + " (m)";
  AreaLayer sole{"feet on the ground", {Ink::limit, 0.12}, {}};
  const auto add_edge = [&](std::size_t i, bool high) {
    const sim::TraceSample& s = trace[i];
    sole.points.push_back({s.time, (high ? s.sole_high : s.sole_low)(index(axis))});
  };
  // Every tick: between two of them an edge jumps by a step.
  for (std::size_t i = 0; i < trace.size(); ++i) add_edge(i, false);
  for (std::size_t i = trace.size(); i-- > 0;) add_edge(i, true);
  plot.layers = {
      std::move(sole),
      LineLayer{
          "ZMP", {Ink::measured, 1.0}, points_of(trace, actual_of(&sim::TraceSample::zmp, axis))},
      LineLayer{"reference", reference_stroke,
                points_of(trace, reference_of(&sim::TraceSample::zmp, axis))}};
  return plot;
}

std::vector<Plot> tracking_plots(const sim::TrackingResult& tracking) {
  std::vector<Plot> plots;
  for (const GroundAxis axis : {GroundAxis::x, GroundAxis::y}) {
    plots.push_back(trajectory_plot(tracking.trace, axis, "lqg-trajectory-" + name_of(axis),
                                    "CoM and DCM in " + name_of(axis)));
    plots.push_back(
        zmp_plot(tracking.trace, axis, "lqg-zmp-" + name_of(axis), "ZMP in " + name_of(axis)));
  }
  for (const GroundAxis axis : {GroundAxis::x, GroundAxis::y}) {
    plots.push_back(error_plot(tracking.trace, axis));
  }
  return plots;
}

std::string strategy_text(sim::SteppingStrategy strategy) {
  return strategy_names[static_cast<std::size_t>(strategy)];
}

Plot push_plot(const sim::PushComparison& push, double width, std::string id) {
  sim::Trace trace = push.trace;
  for (sim::TraceSample& sample : trace) sample.time -= push.ours.push_time;
  const Range shown{-0.5, 2.5};
  std::erase_if(
      trace, [&](const sim::TraceSample& s) { return s.time < shown.low || s.time > shown.high; });
  Plot plot = trajectory_plot(trace, GroundAxis::x, std::move(id),
                              fixed(push.published.force, 0) + " N, " +
                                  strategy_text(push.published.strategy) +
                                  (push.ours.fell ? ": falls" : ""));
  plot.description = "CoM, DCM and ZMP around a push, with their references dashed.";
  plot.width = width;
  plot.height = 0.85 * width;
  plot.x.label = "time from the push (s)";
  plot.x.range = shown;
  const Plot zmp = zmp_plot(trace, GroundAxis::x, "", "");
  plot.layers.insert(plot.layers.begin(), zmp.layers.begin(), zmp.layers.end());
  if (auto* line = std::get_if<LineLayer>(&plot.layers[1])) line->stroke = zmp_stroke;
  return plot;
}

Plot standing_map(const sim::StandingResult& result, double width, std::string id,
                  std::string title) {
  const engine::Parameters parameters = sim::paper_parameters();
  const double omega = engine::natural_frequency(parameters);
  const double bound = sim::standing_bound(result.setup);
  Plot plot;
  plot.id = std::move(id);
  plot.title = std::move(title);
  plot.description = std::to_string(result.recovered) + " of " +
                     std::to_string(result.states.size()) +
                     " initial states were brought to rest; " + std::to_string(result.bound) +
                     " lie within the bound.";
  plot.width = width;
  plot.height = 0.92 * width;
  plot.x = {"position c (m)", Range{-0.21, 0.21}, {}, false};
  plot.y = {"velocity v (m/s)", Range{-1.05, 1.05}, {}, false};
  for (const double c : {-0.2, -0.1, 0.0, 0.1, 0.2}) plot.x.marks.push_back({c, fixed(c, 1)});
  for (const double v : {-1.0, -0.5, 0.0, 0.5, 1.0}) plot.y.marks.push_back({v, fixed(v, 1)});
  BoxLayer recovered{"at rest in 2 s", {Ink::measured}, {}, false, 0.5};
  BoxLayer missed{"within the bound, lost", {Ink::soft}, {}, false, 0.5};
  BoxLayer beyond{"at rest, beyond the bound", {Ink::limit}, {}, false, 0.5};
  BoxLayer lost{"lost", {Ink::ground}, {}, false, 0.5};
  for (const sim::StandingState& s : result.states) {
    BoxLayer& cells =
        s.capturable ? (s.recovered ? recovered : missed) : (s.recovered ? beyond : lost);
    cells.boxes.push_back(
        {{s.position - 0.01, s.velocity - 0.05}, {s.position + 0.01, s.velocity + 0.05}});
  }
  plot.layers.emplace_back(std::move(recovered));
  if (!missed.boxes.empty()) plot.layers.emplace_back(std::move(missed));
  if (!beyond.boxes.empty()) plot.layers.emplace_back(std::move(beyond));
  plot.layers.emplace_back(std::move(lost));
  plot.layers.emplace_back(dcm_line("bound", bound_stroke, bound, omega));
  plot.layers.emplace_back(dcm_line("bound", bound_stroke, -bound, omega));
  plot.layers.emplace_back(dcm_line("c + v/ω = 0", {Ink::text, 1.2, true}, 0.0, omega));
  return plot;
}

Plot standing_example_plot(const sim::StandingExample& example, std::string id, std::string title) {
  const double half = sim::paper_parameters().foot_half_length;
  Plot plot;
  plot.id = std::move(id);
  plot.title = std::move(title);
  plot.description = "CoM, DCM and ZMP over two seconds, between the edges of the foot.";
  plot.height = 280.0;
  plot.x.label = "time (s)";
  plot.x.range = Range{0.0, 2.0};
  plot.y.label = "x (m)";
  // Once lost, the rest of the way down says nothing.
  plot.y.range = Range{-0.2, 0.3};
  const auto line = [&](const char* name, const Stroke& stroke,
                        sim::TracedPoint sim::TraceSample::*point) {
    return LineLayer{name, stroke, points_of(example.trace, actual_of(point, GroundAxis::x))};
  };
  const Range time = *plot.x.range;
  plot.layers = {BoxLayer{"foot", {Ink::limit, 0.12}, {{{time.low, -half}, {time.high, half}}}},
                 line("ZMP", zmp_stroke, &sim::TraceSample::zmp),
                 line("DCM", dcm_stroke, &sim::TraceSample::dcm),
                 line("CoM", com_stroke, &sim::TraceSample::com)};
  return plot;
}

Plot stepping_bars(const std::vector<sim::SteppingLimits>& limits) {
  constexpr double bar = 0.21;      // of the distance between two timings
  constexpr double pitch = 0.29;    // from bar to bar; the spread under noise stands between them
  constexpr double beside = 0.135;  // from a bar's middle to its spread
  Plot plot;
  plot.id = "scenario2-limits";
  plot.title = "First fall, and the ceiling of any controller";
  plot.description = "Three bars for each timing: ankle, ankle and place, ankle, place and time.";
  plot.width = picture_width(1);
  plot.height = 420.0;
  plot.x.label = "single support / double support / single support left at the push (s)";
  plot.x.range = Range{-0.52, static_cast<double>(limits.size()) - 0.44};
  plot.x.grid = false;
  plot.y.label = "force for 10 ms (N)";
  std::array<BoxLayer, 3> bars;
  LineLayer ceiling{"ceiling", {Ink::limit, 2.0}, {}};
  LineLayer spread{"under noise: least, median, greatest", {Ink::text, 1.2}, {}};
  DotLayer median{"", {Ink::text}, {}, 2.6};
  std::vector<Layer> marks;
  double top = 0.0;
  for (std::size_t s = 0; s < bars.size(); ++s) {
    bars[s].name = strategy_names[s];
    bars[s].fill = {strategy_inks[s]};
  }
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const sim::SteppingLimits& l = limits[i];
    std::string label = timing_text(l.timing);
    if (std::abs(l.direction) > 1e-9) label += ", " + direction_text(l.direction);
    plot.x.marks.push_back({static_cast<double>(i), std::move(label)});
    for (std::size_t s = 0; s < bars.size(); ++s) {
      const double middle = static_cast<double>(i) + (static_cast<double>(s) - 1.0) * pitch;
      const double low = middle - 0.5 * bar;
      const double high = middle + 0.5 * bar;
      const double fall = by_strategy(l.fall)[s];
      const double most = by_strategy(l.ceiling)[s];
      bars[s].boxes.push_back({{low, 0.0}, {high, fall}});
      ceiling.points = {{low, most}, {high, most}};
      marks.emplace_back(ceiling);
      marks.emplace_back(
          NoteLayer{{middle, std::max(fall, most)}, fixed(fall, 0), Anchor::middle, 6.0});
      top = std::max({top, fall, most});
      if (l.noise_seeds == 0) continue;
      const double x = middle + beside;
      spread.points = {{x, by_strategy(l.noise_least)[s]}, {x, by_strategy(l.noise_greatest)[s]}};
      marks.emplace_back(spread);
      median.points.push_back({x, by_strategy(l.noise_median)[s]});
      top = std::max(top, by_strategy(l.noise_greatest)[s]);
    }
  }
  plot.y.range = nice_range({0.0, 1.05 * top}, 8);
  for (BoxLayer& layer : bars) plot.layers.emplace_back(std::move(layer));
  for (Layer& layer : marks) plot.layers.push_back(std::move(layer));
  plot.layers.emplace_back(std::move(median));
  return plot;
}

Plot direction_plot(const std::vector<sim::SteppingLimits>& around, double width, std::string id) {
  std::vector<sim::SteppingLimits> sorted = around;
  std::sort(sorted.begin(), sorted.end(),
            [](const auto& a, const auto& b) { return a.direction < b.direction; });
  Plot plot;
  plot.id = std::move(id);
  plot.title = around.empty() ? "" : timing_text(around.front().timing) + " s";
  plot.description =
      "First fall in eight directions for each strategy, with the ceiling, seen from above.";
  plot.width = width;
  plot.height = 0.92 * width;
  plot.x.label = "forward (N)";
  plot.y.label = "to the left (N)";
  plot.equal_aspect = true;
  // The legend keeps the order of the other figures; what is drawn puts small over large.
  for (std::size_t s = 0; s < strategy_names.size(); ++s) {
    plot.layers.emplace_back(LineLayer{strategy_names[s], {strategy_inks[s], 1.6}, {}});
  }
  plot.layers.emplace_back(LineLayer{"ceiling", {Ink::limit, 1.1}, {}});
  const auto force = [](double newtons, double direction) {
    return DataPoint{newtons * std::cos(direction), newtons * std::sin(direction)};
  };
  for (std::size_t s = strategy_names.size(); s-- > 0;) {
    LineLayer ceiling{"ceiling", {Ink::limit, 1.1}, {}, true};
    LineLayer fall{strategy_names[s], {strategy_inks[s], 1.6}, {}, true};
    DotLayer dots{"", {strategy_inks[s]}, {}, 2.2};
    for (const sim::SteppingLimits& l : sorted) {
      ceiling.points.push_back(force(by_strategy(l.ceiling)[s], l.direction));
      fall.points.push_back(force(by_strategy(l.fall)[s], l.direction));
    }
    dots.points = fall.points;
    plot.layers.emplace_back(std::move(ceiling));
    plot.layers.emplace_back(std::move(fall));
    plot.layers.emplace_back(std::move(dots));
  }
  return plot;
}

}  // namespace stagger::server
