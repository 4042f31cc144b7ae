#include "server/report/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stagger::server {
namespace {

// Sizes in the unit of the picture [px]; the style sheet sets the fonts to the same.
constexpr double font = 12.0;
constexpr double title_font = 13.0;
constexpr double legend_line = 18.0;
constexpr double legend_sample = 22.0;
constexpr double space = 6.0;
constexpr double right_margin = 14.0;
constexpr double tolerance = 0.12;

/// Every point of a layer to a visitor.
template <typename Visit>
void each_point(const Layer& layer, const Visit& visit) {
  if (const auto* line = std::get_if<LineLayer>(&layer)) {
    for (const DataPoint& point : line->points) visit(point);
  } else if (const auto* area = std::get_if<AreaLayer>(&layer)) {
    for (const DataPoint& point : area->points) visit(point);
  } else if (const auto* boxes = std::get_if<BoxLayer>(&layer)) {
    for (const BoxLayer::Box& box : boxes->boxes) {
      visit(box.low);
      visit(box.high);
    }
  } else if (const auto* dots = std::get_if<DotLayer>(&layer)) {
    for (const DataPoint& point : dots->points) visit(point);
  }
}

template <typename Member>
Range range_of(const std::vector<Layer>& layers, Member member) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Layer& layer : layers) {
    each_point(layer, [&](const DataPoint& point) {
      if (!std::isfinite(point.*member)) return;
      range.low = std::min(range.low, point.*member);
      range.high = std::max(range.high, point.*member);
    });
  }
  return range;
}

struct LegendEntry {
  std::string name;
  const Layer* layer;
  Pixel at;  ///< relative to the legend's corner
};

struct Legend {
  std::vector<LegendEntry> entries;
  double height = 0.0;
};

std::string name_of(const Layer& layer) {
  return std::visit(
      [](const auto& l) -> std::string {
        if constexpr (requires { l.name; }) {
          return l.name;
        } else {
          return "";
        }
      },
      layer);
}

Legend lay_out_legend(const Plot& plot, double width) {
  Legend legend;
  Pixel at;
  for (const Layer& layer : plot.layers) {
    const std::string name = name_of(layer);
    const bool known = std::any_of(legend.entries.begin(), legend.entries.end(),
                                   [&](const LegendEntry& entry) { return entry.name == name; });
    if (name.empty() || known) continue;
    const double size = legend_sample + space + text_width(name, font);
    if (at.x > 0.0 && at.x + size > width) at = {0.0, at.y + legend_line};
    legend.entries.push_back({name, &layer, at});
    at.x += size + 2.0 * space;
  }
  if (!legend.entries.empty()) legend.height = at.y + legend_line + space;
  return legend;
}

struct Frame {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;
};

struct AxisLayout {
  Range range;
  std::vector<Axis::Mark> marks;
};

AxisLayout lay_out_axis(const Axis& axis, const Range& data, int most) {
  AxisLayout layout;
  layout.range = axis.range ? usable(*axis.range) : padded(data);
  layout.marks = axis.marks;
  if (layout.marks.empty()) {
    const Ticks ticks = nice_ticks(layout.range, most);
    for (const double value : ticks.values) {
      layout.marks.push_back({value, fixed(value, ticks.decimals)});
    }
  }
  return layout;
}

/// The shorter axis (in pixels for a unit) is widened about its middle.
void equalize(Range& x, Range& y, const Frame& frame) {
  const double unit = std::max(x.span() / frame.width, y.span() / frame.height);
  const auto widen = [&](Range& range, double pixels) {
    const double middle = 0.5 * (range.low + range.high);
    range = {middle - 0.5 * unit * pixels, middle + 0.5 * unit * pixels};
  };
  widen(x, frame.width);
  widen(y, frame.height);
}

class Drawing {
 public:
  Drawing(Svg& svg, const Frame& frame, const Range& x, const Range& y)
      : svg_(svg),
        frame_(frame),
        x_(x, {frame.left, frame.left + frame.width}),
        y_(y, {frame.top + frame.height, frame.top}) {}

  Pixel at(const DataPoint& point) const { return {clipped(x_(point.x)), clipped(y_(point.y))}; }

  void operator()(const LineLayer& line) const {
    svg_.polyline(simplified(pixels(line.points), tolerance), line.stroke, line.closed);
  }
  void operator()(const AreaLayer& area) const {
    svg_.polygon(simplified(pixels(area.points), tolerance), area.fill);
  }
  void operator()(const BoxLayer& layer) const {
    for (const BoxLayer::Box& box : layer.boxes) {
      const Pixel a = at(box.low);
      const Pixel b = at(box.high);
      const Pixel corner{std::min(a.x, b.x) + layer.gap, std::min(a.y, b.y) + layer.gap};
      const double width = std::max(0.0, std::abs(a.x - b.x) - 2.0 * layer.gap);
      const double height = std::max(0.0, std::abs(a.y - b.y) - 2.0 * layer.gap);
      if (!box.link.empty()) svg_.begin_link(box.link);
      svg_.rectangle(corner, width, height, layer.fill);
      if (!box.link.empty()) svg_.end_link();
      if (layer.outlined) svg_.outline(corner, width, height, {layer.fill.ink, 1.2});
    }
  }
  void operator()(const DotLayer& dots) const {
    for (const DataPoint& point : dots.points) svg_.circle(at(point), dots.radius, dots.fill);
  }
  void operator()(const NoteLayer& note) const {
    const Pixel place = at(note.at);
    svg_.text({place.x, place.y - note.up}, note.text, note.clear ? "note clear" : "note",
              note.anchor);
  }

 private:
  /// Far outside of the picture is far enough: a diverging line must not write numbers without end.
  static double clipped(double pixel) {
    constexpr double far = 1e4;
    return std::isfinite(pixel) ? std::clamp(pixel, -far, far) : 0.0;
  }
  std::vector<Pixel> pixels(const std::vector<DataPoint>& points) const {
    std::vector<Pixel> result;
    for (const DataPoint& point : points) {
      if (std::isfinite(point.x) && std::isfinite(point.y)) result.push_back(at(point));
    }
    return result;
  }

  Svg& svg_;
  Frame frame_;
  LinearScale x_;
  LinearScale y_;
};

void draw_sample(Svg& svg, const Layer& layer, const Pixel& at) {
  const double middle = at.y - 0.35 * font;
  if (const auto* line = std::get_if<LineLayer>(&layer)) {
    svg.line({at.x, middle}, {at.x + legend_sample, middle}, line->stroke);
  } else if (const auto* dots = std::get_if<DotLayer>(&layer)) {
    svg.circle({at.x + 0.5 * legend_sample, middle}, dots->radius, dots->fill);
  } else {
    const auto* boxes = std::get_if<BoxLayer>(&layer);
    const auto* area = std::get_if<AreaLayer>(&layer);
    const Pixel corner{at.x + 4.0, middle - 5.0};
    const double width = legend_sample - 8.0;
    constexpr double height = 10.0;
    svg.rectangle(corner, width, height, boxes != nullptr ? boxes->fill : area->fill);
    if (boxes != nullptr && boxes->outlined) {
      svg.outline(corner, width, height, {boxes->fill.ink, 1.2});
    }
  }
}

void draw_legend(Svg& svg, const Legend& legend, double top) {
  for (const LegendEntry& entry : legend.entries) {
    const Pixel at{entry.at.x, top + entry.at.y};
    draw_sample(svg, *entry.layer, at);
    svg.text({at.x + legend_sample + space, at.y}, entry.name, "tick");
  }
}

void draw_axes(Svg& svg, const Plot& plot, const Frame& frame, const AxisLayout& x,
               const AxisLayout& y, const Drawing& drawing) {
  const double bottom = frame.top + frame.height;
  const Stroke grid{Ink::ground, 1.0};
  const auto inside = [](double value, const Range& range) {
    const double slack = 1e-9 * range.span();
    return value >= range.low - slack && value <= range.high + slack;
  };
  for (const Axis::Mark& mark : x.marks) {
    if (!inside(mark.value, x.range)) continue;
    const double px = drawing.at({mark.value, y.range.low}).x;
    if (plot.x.grid) svg.line({px, frame.top}, {px, bottom}, grid);
    svg.text({px, bottom + font + 4.0}, mark.text, "tick", Anchor::middle);
  }
  for (const Axis::Mark& mark : y.marks) {
    if (!inside(mark.value, y.range)) continue;
    const double py = drawing.at({x.range.low, mark.value}).y;
    if (plot.y.grid) svg.line({frame.left, py}, {frame.left + frame.width, py}, grid);
    svg.text({frame.left - space, py + 0.35 * font}, mark.text, "tick", Anchor::end);
  }
  svg.text({frame.left + 0.5 * frame.width, plot.height - space}, plot.x.label, "axis",
           Anchor::middle);
  if (!plot.y.label.empty()) {
    svg.text({font, frame.top + 0.5 * frame.height}, plot.y.label, "axis", Anchor::middle, true);
  }
}

}  // namespace

Range padded(const Range& data) {
  constexpr double share = 0.04;
  const Range r = usable(data);
  return {r.low - share * r.span(), r.high + share * r.span()};
}

Range x_range(const std::vector<Layer>& layers) { return range_of(layers, &DataPoint::x); }
Range y_range(const std::vector<Layer>& layers) { return range_of(layers, &DataPoint::y); }

std::string to_svg(const Plot& plot) {
  const Legend legend = plot.legend ? lay_out_legend(plot, plot.width - right_margin) : Legend{};
  Frame frame;
  frame.top = (plot.title.empty() ? space : title_font + 2.0 * space) + legend.height + space;
  frame.height =
      plot.height - frame.top - font - 2.0 * space - (plot.x.label.empty() ? 0.0 : font + space);

  const int most_y = std::clamp(static_cast<int>(frame.height / 38.0), 2, 9);
  AxisLayout y = lay_out_axis(plot.y, y_range(plot.layers), most_y);
  double labels = 0.0;
  for (const Axis::Mark& mark : y.marks) labels = std::max(labels, text_width(mark.text, font));
  frame.left = labels + 2.0 * space + (plot.y.label.empty() ? 0.0 : font + space);
  frame.width = plot.width - frame.left - right_margin;
  const int most_x = std::clamp(static_cast<int>(frame.width / 58.0), 2, 12);
  AxisLayout x = lay_out_axis(plot.x, x_range(plot.layers), most_x);
  if (plot.equal_aspect) {
    equalize(x.range, y.range, frame);
    const auto again = [](const Axis& axis, AxisLayout& layout, int most) {
      Axis widened = axis;
      widened.range = layout.range;
      layout = lay_out_axis(widened, layout.range, most);
    };
    again(plot.x, x, most_x);
    again(plot.y, y, most_y);
  }

  Svg svg(plot.id, plot.width, plot.height, plot.title, plot.description);
  if (!plot.title.empty()) svg.text({0.0, title_font}, plot.title, "title");
  const double legend_top = plot.title.empty() ? font : title_font + 2.0 * space + font - 2.0;
  draw_legend(svg, legend, legend_top);
  const Drawing drawing(svg, frame, x.range, y.range);
  draw_axes(svg, plot, frame, x, y, drawing);
  svg.begin_clip({frame.left, frame.top}, frame.width, frame.height);
  for (const Layer& layer : plot.layers) std::visit(drawing, layer);
  svg.end_clip();
  if (plot.framed)
    svg.outline({frame.left, frame.top}, frame.width, frame.height, {Ink::ground, 1.0});
  return std::move(svg).finish();
}

std::string legend_to_svg(const Plot& plot, double width) {
  const Legend legend = lay_out_legend(plot, width);
  Svg svg(plot.id + "-legend", width, legend.height, "Legend", "What the lines and fillings mean.");
  draw_legend(svg, legend, font);
  return std::move(svg).finish();
}

double legend_height(const Plot& plot, double width) { return lay_out_legend(plot, width).height; }

}  // namespace stagger::server
