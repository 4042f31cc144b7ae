#include "server/report/svg.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "server/report/scale.h"

namespace stagger::server {
namespace {

std::string attribute(std::string_view name, double value) {
  return " " + std::string(name) + "=\"" + coordinate(value) + "\"";
}

std::string class_of(const Stroke& stroke) {
  std::string text = " class=\"line ";
  text += name_of(stroke.ink);
  if (stroke.dashed) text += " dashed";
  text += "\" stroke-width=\"" + coordinate(stroke.width, 2) + "\"";
  return text;
}

std::string class_of(const Fill& fill) {
  std::string text = " class=\"area ";
  text += name_of(fill.ink);
  text += "\"";
  if (fill.opacity < 1.0) text += " fill-opacity=\"" + coordinate(fill.opacity, 2) + "\"";
  return text;
}

double distance_to_segment(const Pixel& p, const Pixel& a, const Pixel& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  const double along =
      squared > 0.0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - along * dx, p.y - a.y - along * dy);
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        // Control characters cannot be in XML at all, not even as entities.
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') out += c;
    }
  }
  return out;
}

std::string_view name_of(Ink ink) {
  switch (ink) {
    case Ink::strong:
      return "strong";
    case Ink::measured:
      return "measured";
    case Ink::soft:
      return "soft";
    case Ink::reference:
      return "reference";
    case Ink::planned:
      return "planned";
    case Ink::limit:
      return "limit";
    case Ink::ground:
      return "ground";
    case Ink::text:
      break;
  }
  return "ink";
}

Svg::Svg(std::string_view id, double width, double height, std::string_view title,
         std::string_view description) {
  const std::string key = escaped(id);
  out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"" + key + "\" viewBox=\"0 0 " +
         coordinate(width) + " " + coordinate(height) + "\"" + attribute("width", width) +
         attribute("height", height) + " role=\"img\" aria-labelledby=\"" + key + "-title " + key +
         "-desc\">\n<title id=\"" + key + "-title\">" + escaped(title) + "</title>\n<desc id=\"" +
         key + "-desc\">" + escaped(description) + "</desc>\n";
}

void Svg::line(const Pixel& from, const Pixel& to, const Stroke& stroke) {
  out_ += "<line" + attribute("x1", from.x) + attribute("y1", from.y) + attribute("x2", to.x) +
          attribute("y2", to.y) + class_of(stroke) + "/>\n";
}

void Svg::path(std::span<const Pixel> points, bool closed) {
  out_ += "<path d=\"";
  char command = 'M';
  for (const Pixel& point : points) {
    out_ += command;
    out_ += coordinate(point.x);
    out_ += ' ';
    out_ += coordinate(point.y);
    command = 'L';
  }
  if (closed) out_ += 'Z';
  out_ += '"';
}

void Svg::polyline(std::span<const Pixel> points, const Stroke& stroke, bool closed) {
  if (points.empty()) return;
  path(points, closed);
  out_ += class_of(stroke) + "/>\n";
}

void Svg::polygon(std::span<const Pixel> points, const Fill& fill) {
  if (points.empty()) return;
  path(points, true);
  out_ += class_of(fill) + "/>\n";
}

void Svg::rectangle(const Pixel& corner, double width, double height, const Fill& fill) {
  out_ += "<rect" + attribute("x", corner.x) + attribute("y", corner.y) +
          attribute("width", width) + attribute("height", height) + class_of(fill) + "/>\n";
}

void Svg::outline(const Pixel& corner, double width, double height, const Stroke& stroke) {
  out_ += "<rect" + attribute("x", corner.x) + attribute("y", corner.y) +
          attribute("width", width) + attribute("height", height) + class_of(stroke) + "/>\n";
}

void Svg::circle(const Pixel& centre, double radius, const Fill& fill) {
  out_ += "<circle" + attribute("cx", centre.x) + attribute("cy", centre.y) +
          attribute("r", radius) + class_of(fill) + "/>\n";
}

void Svg::text(const Pixel& at, std::string_view text, std::string_view style, Anchor anchor,
               bool upright) {
  out_ += "<text" + attribute("x", at.x) + attribute("y", at.y) + " class=\"" + std::string(style) +
          "\"";
  if (anchor == Anchor::middle) out_ += " text-anchor=\"middle\"";
  if (anchor == Anchor::end) out_ += " text-anchor=\"end\"";
  if (upright) {
    out_ += " transform=\"rotate(-90 " + coordinate(at.x) + " " + coordinate(at.y) + ")\"";
  }
  out_ += ">" + escaped(text) + "</text>\n";
}

void Svg::style(std::string_view sheet) {
  out_ += "<style>" + std::string(sheet) +
          "</style>\n<rect width=\"100%\" height=\"100%\" class=\"area page\"/>\n";
}

void Svg::picture(const Pixel& corner, std::string_view svg) {
  out_ +=
      "<g transform=\"translate(" + coordinate(corner.x) + " " + coordinate(corner.y) + ")\">\n";
  out_ += svg;
  out_ += "</g>\n";
}

void Svg::begin_link(std::string_view address) { out_ += "<a href=\"" + escaped(address) + "\">"; }

void Svg::end_link() { out_ += "</a>\n"; }

void Svg::begin_clip(const Pixel& corner, double width, double height) {
  // A nested picture clips by itself and needs no name, unlike a clip path.
  out_ += "<svg" + attribute("x", corner.x) + attribute("y", corner.y) + attribute("width", width) +
          attribute("height", height) + " viewBox=\"" + coordinate(corner.x) + " " +
          coordinate(corner.y) + " " + coordinate(width) + " " + coordinate(height) + "\">\n";
}

void Svg::end_clip() { out_ += "</svg>\n"; }

std::string Svg::finish() && {
  out_ += "</svg>\n";
  return std::move(out_);
}

std::vector<Pixel> simplified(std::span<const Pixel> points, double tolerance) {
  if (points.size() < 3) return {points.begin(), points.end()};
  // Douglas and Peucker: a stretch is a straight line unless a point lies off it.
  std::vector<char> kept(points.size(), 0);
  kept.front() = kept.back() = 1;
  std::vector<std::pair<std::size_t, std::size_t>> stretches{{0, points.size() - 1}};
  while (!stretches.empty()) {
    const auto [first, last] = stretches.back();
    stretches.pop_back();
    double worst = tolerance;
    std::size_t split = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double off = distance_to_segment(points[i], points[first], points[last]);
      if (off <= worst) continue;
      worst = off;
      split = i;
    }
    if (split == 0) continue;
    kept[split] = 1;
    stretches.emplace_back(first, split);
    stretches.emplace_back(split, last);
  }
  std::vector<Pixel> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (kept[i] != 0) result.push_back(points[i]);
  }
  return result;
}

double text_width(std::string_view text, double font_size) {
  // One for each character, not for each byte of UTF-8. DejaVu Sans, among the widest of the
  // system fonts, takes 0.6 em on average.
  const auto characters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  });
  return 0.6 * font_size * static_cast<double>(characters);
}

}  // namespace stagger::server
