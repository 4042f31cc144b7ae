// Plots side by side under one caption: a part of a page, or a file of its own.
#pragma once

#include <string>
#include <vector>

#include "server/report/svg_plot.h"

namespace stagger::server {

struct Figure {
  std::string id;
  std::string caption;
  int columns = 2;  ///< 1 to 4 on a wide page
  std::vector<Plot> plots;
  bool one_legend = false;  ///< over all plots instead of one in each
};

/// Of the page [px].
inline constexpr double page_width = 1080.0;
/// Width of a plot in a figure of so many columns, all in all this wide [px].
double picture_width(int columns, double figure_width = page_width);

/// <svg> elements: the plots, and the legend over them where there is one for all.
std::vector<std::string> pictures_of(const Figure& figure);
std::string legend_of(const Figure& figure);

/// All of it as one SVG file that needs nothing else, light, for papers and other pages. `note`
/// stands below: under what conditions it was made.
std::string figure_file(const Figure& figure, const std::string& note);

}  // namespace stagger::server
