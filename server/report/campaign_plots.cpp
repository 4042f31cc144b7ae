#include "server/report/campaign_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "server/report/campaign_labels.h"

namespace stagger::server {
namespace {

constexpr std::array<Ink, 5> series_inks{Ink::soft, Ink::reference, Ink::planned, Ink::measured,
                                         Ink::strong};
constexpr double note_font = 11.0;

double middle_of(std::size_t place) { return static_cast<double>(place) + 0.5; }

std::string percent_words(double share) { return fixed(100.0 * share, 0); }

std::string interval_words(const campaign::Estimate& share) {
  return percent_words(share.low) + "–" + percent_words(share.high);
}

/// Pale blue where all pass; where any fails the redder the more do. In greys it grows darker all
/// the way, and the colour-blind tell blue from red.
Fill shade(double share) {
  constexpr double palest = 0.26;
  constexpr double deepest = 0.7;
  if (share >= 1.0) return {Ink::measured, palest};
  return {Ink::limit, palest + (deepest - palest) * (1.0 - share)};
}

std::vector<Axis::Mark> marks_of(const VariedField& field) {
  std::vector<Axis::Mark> marks;
  for (std::size_t i = 0; i < field.labels.size(); ++i) {
    marks.push_back({middle_of(i), field.labels[i]});
  }
  return marks;
}

/// Fewer marks when they would run into one another: `room` for marks of this size each [px].
void thin_out(std::vector<Axis::Mark>& marks, double room, double size) {
  const auto fit = std::max(1.0, std::floor(room / size));
  const auto every = static_cast<std::size_t>(std::ceil(static_cast<double>(marks.size()) / fit));
  std::size_t at = 0;
  std::erase_if(marks, [&](const Axis::Mark&) { return at++ % every != 0; });
}

double widest(const std::vector<Axis::Mark>& marks) {
  double width = 0.0;
  for (const Axis::Mark& mark : marks) width = std::max(width, text_width(mark.text, 12.0));
  return width;
}

/// What is known of a cell.
struct Tally {
  std::uint64_t passed = 0;
  std::uint64_t trials = 0;
  bool operator==(const Tally&) const = default;
  campaign::Estimate share() const { return *campaign::share_of(passed, trials); }
};
Tally tally_of(const Survival& survival) { return {survival.passed, survival.trials()}; }

/// All that occur in the map, the best ones first.
std::vector<Tally> tallies_of(const SurvivalMap& map) {
  std::vector<Tally> tallies;
  for (const SurvivalMap::Panel& panel : map.panels) {
    for (const Survival& cell : panel.cells) {
      const Tally tally = tally_of(cell);
      const bool known = std::find(tallies.begin(), tallies.end(), tally) != tallies.end();
      if (tally.trials > 0 && !known) tallies.push_back(tally);
    }
  }
  std::sort(tallies.begin(), tallies.end(), [](const Tally& a, const Tally& b) {
    return std::pair(b.share().value, b.trials) < std::pair(a.share().value, a.trials);
  });
  return tallies;
}

/// In the legend: "2 of 3 (21–94 %)"; where they are too many, the ends alone.
std::string tally_words(const Tally& tally, bool each) {
  if (each) {
    return std::to_string(tally.passed) + " of " + std::to_string(tally.trials) + " (" +
           interval_words(tally.share()) + " %)";
  }
  if (tally.passed == tally.trials) return "all pass";
  return tally.passed == 0 ? "none passes" : "";
}

Range cells_of(const VariedField& field) {
  return {0.0, static_cast<double>(std::max<std::size_t>(field.labels.size(), 1))};
}

Ink series_ink(std::size_t i, std::size_t count) {
  // The last one is the darkest: sets of strategies grow.
  return series_inks[(i + series_inks.size() - std::min(count, series_inks.size())) %
                     series_inks.size()];
}

/// Interval as a line with ends, centre as a dot.
void draw_estimate(Plot& plot, const campaign::Estimate& share, const DataPoint& at, bool upright,
                   Ink ink) {
  const auto point = [&](double value) {
    return upright ? DataPoint{at.x, 100.0 * value} : DataPoint{100.0 * value, at.y};
  };
  plot.layers.emplace_back(LineLayer{"", {ink, 1.2}, {point(share.low), point(share.high)}});
  plot.layers.emplace_back(DotLayer{"", {ink}, {point(share.value)}, 3.4});
}

}  // namespace

Plot heat_map(const SurvivalMap& map, const SurvivalMap::Panel& panel, const TrialLink& link,
              double width, std::string id) {
  Plot plot;
  plot.id = std::move(id);
  plot.title = panel.title;
  plot.description =
      "Trials that pass over " + path_words(map.x.path) + " and " + path_words(map.y.path) + ".";
  plot.width = width;
  plot.x = {path_words(map.x.path), cells_of(map.x), marks_of(map.x), false};
  plot.y = {path_words(map.y.path), cells_of(map.y), marks_of(map.y), false};
  const double room = std::max(80.0, width - widest(plot.y.marks) - 50.0);
  const double cell = room / static_cast<double>(map.columns());
  const std::size_t rows = map.y.labels.size();
  constexpr double two_lines = 30.0;
  constexpr double one_line = 18.0;
  constexpr double least_height = 10.0;
  constexpr std::size_t most_named = 6;
  const std::vector<Tally> tallies = tallies_of(map);
  const bool named = tallies.size() <= most_named;
  const bool with_count = cell >= 26.0 && rows <= 24;
  const bool with_interval = !named && cell >= 46.0 && with_count;
  const double height = with_interval ? two_lines
                        : with_count  ? one_line
                                      : std::clamp(cell, least_height, one_line);
  plot.height = 64.0 + height * static_cast<double>(rows);
  thin_out(plot.x.marks, room, widest(plot.x.marks) + 6.0);
  thin_out(plot.y.marks, height * static_cast<double>(rows), 16.0);

  // A layer for each tally, all of them in each panel: their legend is the same then.
  std::vector<BoxLayer> layers;
  layers.reserve(tallies.size());
  for (const Tally& tally : tallies) {
    layers.push_back({tally_words(tally, named), shade(tally.share().value), {}, false, 0.5});
  }
  std::vector<NoteLayer> notes;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < map.columns(); ++column) {
      const Survival& survival = map.at(panel, column, row);
      const auto share = survival.share();
      if (!share) continue;
      const auto x = static_cast<double>(column);
      const auto y = static_cast<double>(row);
      const auto tally = std::find(tallies.begin(), tallies.end(), tally_of(survival));
      layers[static_cast<std::size_t>(tally - tallies.begin())].boxes.push_back(
          {{x, y},
           {x + 1.0, y + 1.0},
           survival.failed > 0 && link ? link(survival.first_failed) : ""});
      const DataPoint centre{x + 0.5, y + 0.5};
      const std::string count =
          std::to_string(survival.passed) + "/" + std::to_string(survival.trials());
      if (with_count && text_width(count, note_font) < cell + 4.0) {
        notes.push_back({centre, count, Anchor::middle, with_interval ? 2.5 : -4.0});
      }
      if (with_interval) notes.push_back({centre, interval_words(*share), Anchor::middle, -10.0});
    }
  }
  for (BoxLayer& layer : layers) plot.layers.emplace_back(std::move(layer));
  for (NoteLayer& note : notes) plot.layers.emplace_back(std::move(note));
  return plot;
}

Plot survival_rows(const SurvivalMap& map, double width, std::string id) {
  Plot plot;
  plot.id = std::move(id);
  plot.title = map.panels.size() > 1 ? "" : "Share of trials that pass";
  plot.description =
      "Share of trials that pass, with 95 % intervals, by " + path_words(map.y.path) + ".";
  plot.width = width;
  const std::size_t rows = map.y.labels.size();
  const double row_height =
      14.0 + 8.0 * static_cast<double>(std::max<std::size_t>(map.panels.size(), 1));
  plot.height = 90.0 + row_height * static_cast<double>(rows);
  plot.x = {"trials that pass (%)", Range{-2.0, 102.0}, {}, true};
  plot.y = {"", Range{-static_cast<double>(rows), 0.0}, {}, false};
  // The first row is at the top, as in the specification.
  for (std::size_t row = 0; row < rows; ++row) {
    plot.y.marks.push_back({-middle_of(row), map.y.labels[row]});
  }
  const std::size_t panels = map.panels.size();
  for (std::size_t p = 0; p < panels; ++p) {
    const Ink ink = panels == 1 ? Ink::measured : series_ink(p, panels);
    plot.layers.emplace_back(LineLayer{panels > 1 ? map.panels[p].title : "", {ink, 1.2}, {}});
    for (std::size_t row = 0; row < rows; ++row) {
      const auto share = map.at(map.panels[p], 0, row).share();
      const double offset = (static_cast<double>(p) + 1.0) / static_cast<double>(panels + 1);
      if (share) draw_estimate(plot, *share, {0.0, -static_cast<double>(row) - offset}, false, ink);
    }
  }
  return plot;
}

Plot survival_curves(const SurvivalMap& map, double width, std::string id) {
  Plot plot;
  plot.id = std::move(id);
  plot.description = "Share of trials that pass over " + path_words(map.x.path) +
                     ", with 95 % intervals, by " + path_words(map.y.path) + ".";
  plot.width = width;
  plot.height = 0.7 * width + 40.0;
  plot.x.label = path_words(map.x.path);
  plot.y = {"trials that pass (%)", Range{-3.0, 103.0}, {}, true};
  const bool numbers = !map.x.numbers.empty();
  if (!numbers) plot.x.marks = marks_of(map.x);
  const std::size_t count = map.y.labels.size();
  const auto x_of = [&](std::size_t i) { return numbers ? map.x.numbers[i] : middle_of(i); };
  const double span = x_of(map.columns() - 1) - x_of(0);
  for (std::size_t row = 0; row < count; ++row) {
    const Ink ink = series_ink(row, count);
    const bool dashed = (count - row) % 2 == 0;  // neighbours differ in greys as well
    LineLayer line{map.y.labels[row], {ink, 1.8, dashed}, {}};
    // Side by side, so that intervals do not hide one another.
    const double shift =
        0.008 * span * (static_cast<double>(row) - 0.5 * static_cast<double>(count - 1));
    std::vector<std::pair<campaign::Estimate, double>> estimates;
    for (std::size_t i = 0; i < map.columns(); ++i) {
      if (map.panels.empty()) break;
      if (const auto share = map.at(map.panels.front(), i, row).share()) {
        estimates.emplace_back(*share, x_of(i) + shift);
        line.points.push_back({x_of(i) + shift, 100.0 * share->value});
      }
    }
    plot.layers.emplace_back(std::move(line));
    for (const auto& [share, x] : estimates) draw_estimate(plot, share, {x, 0.0}, true, ink);
  }
  return plot;
}

}  // namespace stagger::server
