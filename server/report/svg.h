// Writes one SVG picture, element by element. Knows no axes: plots of any kind build on it. Colours
// and fonts come from a style sheet, through classes.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stagger::server {

/// Text for XML: & < > " ' as entities; bytes that XML does not allow are left out.
std::string escaped(std::string_view text);

/// What a mark stands for; the page's style sheet gives each a colour for light, dark and print.
enum class Ink : unsigned char {
  strong,  ///< three tones of the colour for what was measured, dark to light
  measured,
  soft,
  reference,  ///< what should be, or what others say
  planned,
  limit,   ///< what cannot be passed
  ground,  ///< filling without a message
  text
};
std::string_view name_of(Ink ink);

/// A place in the picture [px], y downwards.
struct Pixel {
  double x = 0.0;
  double y = 0.0;
};

struct Stroke {
  Ink ink = Ink::measured;
  double width = 1.5;  ///< [px]
  bool dashed = false;
};

struct Fill {
  Ink ink = Ink::measured;
  double opacity = 1.0;
};

enum class Anchor : unsigned char { start, middle, end };

class Svg {
 public:
  /// `id` is unique in the page; title and description are for readers who do not see the picture.
  Svg(std::string_view id, double width, double height, std::string_view title,
      std::string_view description);

  void line(const Pixel& from, const Pixel& to, const Stroke& stroke);
  void polyline(std::span<const Pixel> points, const Stroke& stroke, bool closed = false);
  void polygon(std::span<const Pixel> points, const Fill& fill);
  void rectangle(const Pixel& corner, double width, double height, const Fill& fill);
  void outline(const Pixel& corner, double width, double height, const Stroke& stroke);
  void circle(const Pixel& centre, double radius, const Fill& fill);
  /// `style` is a class of the page's style sheet: "tick", "axis", "title", "note", "foot".
  void text(const Pixel& at, std::string_view text, std::string_view style,
            Anchor anchor = Anchor::start, bool upright = false);

  /// For a picture that is no part of a page: its style sheet.
  void style(std::string_view sheet);
  /// Another picture inside of this one.
  void picture(const Pixel& corner, std::string_view svg);

  /// What follows, until the end, leads to this place: "#trial-7".
  void begin_link(std::string_view address);
  void end_link();
  /// What follows, until the end, is cut off at this rectangle; coordinates stay as they are.
  void begin_clip(const Pixel& corner, double width, double height);
  void end_clip();

  /// The whole element; nothing can be added afterwards.
  std::string finish() &&;

 private:
  void path(std::span<const Pixel> points, bool closed);

  std::string out_;
};

/// Without the points that change the line by less than `tolerance` [px].
std::vector<Pixel> simplified(std::span<const Pixel> points, double tolerance);

/// Width that the text takes at most, as far as one can tell without the font [px].
double text_width(std::string_view text, double font_size);

}  // namespace stagger::server
