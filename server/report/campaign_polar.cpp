#include "server/report/campaign_polar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

#include "server/report/campaign_labels.h"
#include "server/report/campaign_survival.h"
#include "server/report/published_pushes.h"

namespace stagger::server {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180.0;
/// Published pushes are of one direction; so much to either side makes an arc of each.
constexpr double arc_deg = 18.0;
/// What is seen, as a multiple of the greatest Fr that is drawn.
constexpr double picture_reach = 1.1;
constexpr std::array<Ink, 4> inks{Ink::measured, Ink::strong, Ink::planned, Ink::soft};

DataPoint place(double fr, double degrees) {
  return {fr * std::cos(degrees * radians_per_degree), fr * std::sin(degrees * radians_per_degree)};
}

/// From one direction round to the other, the radius changing evenly.
struct Arc {
  double from_deg = 0.0;
  double to_deg = 360.0;
  double from_fr = 0.0;
  double to_fr = 0.0;
};

LineLayer drawn(const Arc& arc, const Stroke& stroke, std::string name) {
  LineLayer line{std::move(name), stroke, {}};
  const int pieces = std::max(2, static_cast<int>(std::ceil((arc.to_deg - arc.from_deg) / 3.0)));
  for (int i = 0; i <= pieces; ++i) {
    const double share = static_cast<double>(i) / pieces;
    line.points.push_back(place(arc.from_fr + (arc.to_fr - arc.from_fr) * share,
                                arc.from_deg + (arc.to_deg - arc.from_deg) * share));
  }
  return line;
}

/// Degrees of a published push; nothing when there is no such side.
std::optional<double> degrees_of(PushSide side, const std::optional<engine::Side>& stance) {
  // Outward is to the side of the foot that swings.
  const double out = stance == engine::Side::right ? 1.0 : -1.0;
  switch (side) {
    case PushSide::forward:
      return 0.0;
    case PushSide::back:
      return 180.0;
    case PushSide::diagonal:
      return stance ? std::optional(out * 26.57) : std::nullopt;
    case PushSide::outward:
      return stance ? std::optional(out * 90.0) : std::nullopt;
    case PushSide::inward:
      return stance ? std::optional(out * -90.0) : std::nullopt;
  }
  return std::nullopt;
}

Ticks rings(double reach) { return nice_ticks({0.0, reach}, 5); }

void draw_rings(Plot& plot, double reach) {
  const Ticks ticks = rings(reach);
  for (int spoke = 0; spoke < 8; ++spoke) {
    plot.layers.emplace_back(
        LineLayer{"", {Ink::ground, 1.0}, {{0.0, 0.0}, place(reach, spoke * 45.0)}});
  }
  for (const double ring : ticks.values) {
    if (ring > 0.0)
      plot.layers.emplace_back(drawn({0.0, 360.0, ring, ring}, {Ink::ground, 1.0}, ""));
  }
}

/// Over all lines, which keep clear of it.
void label_rings(Plot& plot, double reach) {
  const Ticks ticks = rings(reach);
  for (const double ring : ticks.values) {
    if (ring <= 0.0) continue;
    const std::string unit = ring == ticks.values.back() ? "Fr " : "";
    plot.layers.emplace_back(NoteLayer{place(ring, 292.5), unit + fixed(ring, ticks.decimals),
                                       Anchor::middle, -4.0, true});
  }
}

/// Where is what; and how far the ceiling is where it lies outside of the picture.
void label_sides(Plot& plot, double reach, const std::vector<PolarLimit>& limits) {
  const auto ceiling = [&](double degrees) -> std::string {
    for (const PolarLimit& limit : limits) {
      const bool there = std::abs(std::remainder(limit.direction_deg - degrees, 360.0)) < 1e-6;
      if (there && limit.ceiling.value_or(0.0) > picture_reach * reach) {
        return "ceiling " + fixed(*limit.ceiling, 2);
      }
    }
    return "";
  };
  const double edge = 1.08 * reach;
  const auto note = [&](DataPoint at, const std::string& text, Anchor anchor, double up) {
    if (!text.empty()) plot.layers.emplace_back(NoteLayer{at, text, anchor, up, true});
  };
  note({edge, 0.0}, "forward", Anchor::end, 4.0);
  note({edge, 0.0}, ceiling(0.0), Anchor::end, -13.0);
  note({-edge, 0.0}, "back", Anchor::start, 4.0);
  note({-edge, 0.0}, ceiling(180.0), Anchor::start, -13.0);
  const auto beside = [](const char* name, const std::string& more) {
    return more.empty() ? name : name + (", " + more);
  };
  note({0.0, edge}, beside("left", ceiling(90.0)), Anchor::middle, -8.0);
  note({0.0, -edge}, beside("right", ceiling(270.0)), Anchor::middle, 2.0);
}

void draw_published(Plot& plot, const std::optional<engine::Side>& stance) {
  std::map<double, double> thresholds;  // Fr by direction
  for (const PublishedPush& push : published_pushes) {
    const auto degrees = degrees_of(push.side, stance);
    if (!degrees) continue;
    // The name tells them apart, and in greys so does the line.
    const bool threshold = push.who == atlas_name;
    const bool paper = push.side == PushSide::forward && !threshold;
    const Stroke stroke{paper ? Ink::text : Ink::reference, threshold ? 3.2 : 2.0,
                        !threshold && !paper};
    plot.layers.emplace_back(drawn({*degrees - arc_deg, *degrees + arc_deg, push.fr, push.fr},
                                   stroke, std::string(push.who)));
    if (threshold) thresholds[*degrees] = push.fr;
  }
  // A ring for the eye; without the sides there is none.
  if (!stance) return;
  for (auto at = thresholds.begin(); at != thresholds.end(); ++at) {
    const bool last = std::next(at) == thresholds.end();
    const auto to = last ? thresholds.begin() : std::next(at);
    plot.layers.emplace_back(drawn(
        {at->first + arc_deg, to->first - arc_deg + (last ? 360.0 : 0.0), at->second, to->second},
        {Ink::reference, 0.8}, ""));
  }
}

/// Do the directions go all around, so that first and last are neighbours too?
bool goes_around(const std::vector<PolarLimit>& limits) {
  if (limits.size() < 3) return false;
  const double open = 360.0 - (limits.back().direction_deg - limits.front().direction_deg);
  return open <= 360.0 / static_cast<double>(limits.size()) + 46.0;
}

/// Lines between directions that are known; one that is not makes a gap.
template <typename Value>
void draw_line(Plot& plot, const std::vector<PolarLimit>& limits, Value value, const Stroke& stroke,
               const std::string& name) {
  std::vector<LineLayer> lines{{name, stroke, {}}};
  for (const PolarLimit& limit : limits) {
    if (const std::optional<double> fr = value(limit)) {
      lines.back().points.push_back(place(*fr, limit.direction_deg));
    } else if (!lines.back().points.empty()) {
      lines.push_back({name, stroke, {}});
    }
  }
  if (goes_around(limits)) {
    if (lines.size() == 1) {
      lines.front().closed = lines.front().points.size() == limits.size();
    } else if (value(limits.front()) && value(limits.back())) {
      lines.back().points.push_back(lines.front().points.front());
    }
  }
  for (LineLayer& line : lines) {
    if (!line.points.empty()) plot.layers.emplace_back(std::move(line));
  }
}

std::optional<engine::Side> stance_of(const sim::TrialSpec& spec) {
  if (!spec.push) return std::nullopt;
  const auto* phase = std::get_if<sim::PhaseTrigger>(&spec.push->trigger);
  const bool single = phase != nullptr && phase->phase == engine::WalkingState::single_support;
  return single ? phase->leg : std::nullopt;
}

std::string moment_of(const campaign::PlannedTrial& trial) {
  if (!trial.resolved.contains("push")) return "";
  const Json& push = trial.resolved["push"];
  if (push.contains("trigger")) return value_words("push.trigger", push["trigger"]);
  return push.contains("at_s") ? "at " + flat_words(push["at_s"]) + " s" : "at once";
}

}  // namespace

std::vector<PolarPanel> polar_panels(const campaign::Plan& plan,
                                     const std::vector<campaign::CellLimit>& limits) {
  std::vector<PolarPanel> panels;
  std::map<std::string, std::size_t> known;
  if (!is_hardness(plan.spec().design.bisection.axis)) return panels;
  for (const campaign::CellLimit& found : limits) {
    const auto direction = found.values.find("push.direction_deg");
    if (direction == found.values.end() || !direction->is_number()) continue;
    const auto trial_at = [&](std::uint64_t level) {
      return plan.trial(plan.design().number({found.limit.cell, level, 0}));
    };
    const campaign::PlannedTrial lowest = trial_at(0);
    const std::string moment = moment_of(lowest);
    const auto at = known.emplace(moment, panels.size()).first->second;
    if (at == panels.size()) panels.push_back({moment, stance_of(lowest.spec), {}});

    Json others = found.values;
    others.erase("push.direction_deg");
    for (const auto& [path, value] : found.values.items()) {
      if (path.starts_with("push.trigger")) others.erase(path);
    }
    std::string name = values_words(others);
    if (name.empty()) name = "all trials pass up to here";
    auto& series = panels[at].series;
    auto one = std::find_if(series.begin(), series.end(),
                            [&](const PolarSeries& known_one) { return known_one.name == name; });
    if (one == series.end()) one = series.insert(series.end(), {name, {}});

    PolarLimit limit{direction->get<double>(), {}, {}, {}, found.limit.monotone};
    const bool says = !found.limit.undecided && (found.limit.pass || found.limit.fail);
    if (says) limit.pass = found.limit.pass ? trial_at(*found.limit.pass).push.fr : 0.0;
    if (says && found.limit.fail) limit.fail = trial_at(*found.limit.fail).push.fr;
    if (found.ceiling_dv && lowest.push.delta_v > 0.0) {
      limit.ceiling = *found.ceiling_dv * lowest.push.fr / lowest.push.delta_v;
    }
    one->limits.push_back(limit);
  }
  for (PolarPanel& panel : panels) {
    for (PolarSeries& series : panel.series) {
      std::sort(series.limits.begin(), series.limits.end(),
                [](const auto& a, const auto& b) { return a.direction_deg < b.direction_deg; });
    }
  }
  return panels;
}

double polar_reach(const std::vector<PolarPanel>& panels) {
  double found = 0.26;  // all that is published
  double ceiling = 0.0;
  for (const PolarPanel& panel : panels) {
    for (const PolarSeries& series : panel.series) {
      for (const PolarLimit& limit : series.limits) {
        found = std::max({found, limit.pass.value_or(0.0), limit.fail.value_or(0.0)});
        ceiling = std::max(ceiling, limit.ceiling.value_or(0.0));
      }
    }
  }
  // A ceiling far above must not make the rest small.
  constexpr double most_room = 1.6;
  return 1.04 * std::max(found, std::min(ceiling, most_room * found));
}

Plot polar_plot(const PolarPanel& panel, double reach, double width, std::string id) {
  Plot plot;
  plot.id = std::move(id);
  plot.title = panel.title;
  plot.description =
      "Greatest Fr that all trials pass, over the direction of the push, from above.";
  plot.width = width;
  plot.height = width + 8.0;
  plot.equal_aspect = true;
  plot.framed = false;
  plot.x.range = plot.y.range = Range{-picture_reach * reach, picture_reach * reach};
  plot.x.marks = plot.y.marks = {{10.0 * reach, ""}};  // the rings tell
  draw_rings(plot, reach);
  draw_published(plot, panel.stance);
  for (std::size_t i = panel.series.size(); i-- > 0;) {
    const auto& limits = panel.series[i].limits;
    const Ink ink = inks[i % inks.size()];
    if (i == 0) {
      draw_line(
          plot, limits, [](const PolarLimit& l) { return l.ceiling; }, {Ink::limit, 1.3},
          "ceiling of the pendulum model");
    }
    if (panel.series.size() == 1) {
      draw_line(
          plot, limits, [](const PolarLimit& l) { return l.fail; }, {ink, 1.0, true},
          "lowest level at which a trial fails");
    }
    draw_line(
        plot, limits, [](const PolarLimit& l) { return l.pass; }, {ink, 2.0}, panel.series[i].name);
    DotLayer dots{"", {ink}, {}, 2.4};
    DotLayer odd{"not monotone: a harder push passes", {Ink::limit}, {}, 3.4};
    DotLayer open{"all levels pass: the limit lies beyond", {ink, 0.45}, {}, 5.0};
    for (const PolarLimit& limit : limits) {
      if (!limit.pass) continue;
      const DataPoint at = place(*limit.pass, limit.direction_deg);
      dots.points.push_back(at);
      if (!limit.fail) open.points.push_back(at);
      if (!limit.monotone) odd.points.push_back(at);
    }
    for (DotLayer* layer : {&open, &dots, &odd}) {
      if (!layer->points.empty()) plot.layers.emplace_back(std::move(*layer));
    }
  }
  label_rings(plot, reach);
  if (!panel.series.empty()) label_sides(plot, reach, panel.series.front().limits);
  return plot;
}

}  // namespace stagger::server
