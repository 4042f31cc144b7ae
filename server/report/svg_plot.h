// A plot with two axes, drawn from layers; the last one lies on top. Data coordinates may be in any
// unit: axes tell which.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/report/scale.h"
#include "server/report/svg.h"

namespace stagger::server {

struct DataPoint {
  double x = 0.0;
  double y = 0.0;
};

/// A name makes an entry of the legend; layers of the same name and look share one.
struct LineLayer {
  std::string name;
  Stroke stroke;
  std::vector<DataPoint> points;
  bool closed = false;
};

struct AreaLayer {
  std::string name;
  Fill fill;
  std::vector<DataPoint> points;  ///< corners, either way round
};

struct BoxLayer {
  struct Box {
    DataPoint low;
    DataPoint high;
    std::string link = "";  ///< where it leads to, or nothing
  };
  std::string name;
  Fill fill;
  std::vector<Box> boxes;  ///< bars, cells of a map, footprints
  bool outlined = false;   ///< with a line of the same ink around it
  double gap = 0.0;        ///< left free around each box [px]
};

struct DotLayer {
  std::string name;
  Fill fill;
  std::vector<DataPoint> points;
  double radius = 2.5;  ///< [px]
};

struct NoteLayer {
  DataPoint at;
  std::string text;
  Anchor anchor = Anchor::start;
  double up = 0.0;     ///< shift [px]
  bool clear = false;  ///< lines behind it are kept away
};

using Layer = std::variant<LineLayer, AreaLayer, BoxLayer, DotLayer, NoteLayer>;

struct Axis {
  struct Mark {
    double value = 0.0;
    std::string text;
  };
  std::string label;           ///< with the unit: "x (m)"
  std::optional<Range> range;  ///< what lies beyond is cut off; left out: all data, padded
  std::vector<Mark> marks;     ///< instead of numbers at nice places
  bool grid = true;
};

struct Plot {
  std::string id;           ///< unique in the page
  std::string title;        ///< stands above the plot
  std::string description;  ///< for readers who do not see it
  double width = 520.0;     ///< [px]
  double height = 330.0;
  Axis x;
  Axis y;
  bool equal_aspect = false;  ///< one unit is as long on both axes
  bool legend = true;
  bool framed = true;
  std::vector<Layer> layers;
};

/// The plot as one <svg> element.
std::string to_svg(const Plot& plot);
/// Its legend alone, for several plots that share one; "-legend" is added to the id.
std::string legend_to_svg(const Plot& plot, double width);
double legend_height(const Plot& plot, double width);

/// Smallest range with all data of the layers on one axis; notes do not count.
Range x_range(const std::vector<Layer>& layers);
Range y_range(const std::vector<Layer>& layers);
/// With a little room, so that no line runs along the frame.
Range padded(const Range& data);

}  // namespace stagger::server
