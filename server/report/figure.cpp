#include "server/report/figure.h"

#include <algorithm>

#include "server/report/style.h"

namespace stagger::server {
namespace {

constexpr double legend_width = 560.0;  // fits on a narrow page as well
constexpr double column_gap = 28.0;
constexpr double row_gap = 20.0;
constexpr double margin = 12.0;
constexpr double note_font = 11.0;
constexpr double note_line = 15.0;

/// Lines of at most this width, broken at spaces.
std::vector<std::string> lines_of(const std::string& text, double width) {
  std::vector<std::string> lines(1);
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, end - from);
    if (!lines.back().empty() && text_width(lines.back() + " " + word, note_font) > width) {
      lines.emplace_back();
    }
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    from = end + 1;
  }
  return lines;
}

Plot all_layers(const Figure& figure) {
  Plot all;
  all.id = figure.id;
  for (const Plot& plot : figure.plots) {
    all.layers.insert(all.layers.end(), plot.layers.begin(), plot.layers.end());
  }
  return all;
}

}  // namespace

double picture_width(int columns, double figure_width) {
  return (figure_width - column_gap * (columns - 1)) / std::max(columns, 1);
}

std::vector<std::string> pictures_of(const Figure& figure) {
  std::vector<std::string> pictures;
  pictures.reserve(figure.plots.size());
  for (Plot plot : figure.plots) {
    if (figure.one_legend) plot.legend = false;
    pictures.push_back(to_svg(plot));
  }
  return pictures;
}

std::string legend_of(const Figure& figure) {
  return figure.one_legend ? legend_to_svg(all_layers(figure), legend_width) : "";
}

std::string figure_file(const Figure& figure, const std::string& note) {
  const auto columns =
      std::clamp<std::size_t>(figure.plots.size(), 1, static_cast<std::size_t>(figure.columns));
  double column = 0.0;
  for (const Plot& plot : figure.plots) column = std::max(column, plot.width);
  const double inner = static_cast<double>(columns) * (column + column_gap) - column_gap;
  const Plot all = all_layers(figure);
  const double legend = figure.one_legend ? legend_height(all, inner) + row_gap : 0.0;
  const std::vector<std::string> notes = lines_of(note, inner);

  std::vector<double> tops{margin + legend};
  for (std::size_t i = 0; i < figure.plots.size(); i += columns) {
    double height = 0.0;
    for (std::size_t k = i; k < std::min(i + columns, figure.plots.size()); ++k) {
      height = std::max(height, figure.plots[k].height);
    }
    tops.push_back(tops.back() + height + row_gap);
  }
  const double height = tops.back() + note_line * static_cast<double>(notes.size()) + margin;

  Svg svg(figure.id, inner + 2.0 * margin, height, note, figure.caption);
  svg.style(figure_style());
  if (figure.one_legend) svg.picture({margin, margin}, legend_to_svg(all, inner));
  const std::vector<std::string> pictures = pictures_of(figure);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const double left = margin + static_cast<double>(i % columns) * (column + column_gap);
    svg.picture({left, tops[i / columns]}, pictures[i]);
  }
  for (std::size_t i = 0; i < notes.size(); ++i) {
    svg.text({margin, tops.back() + note_line * static_cast<double>(i) + note_font}, notes[i],
             "foot");
  }
  return std::move(svg).finish();
}

}  // namespace stagger::server
