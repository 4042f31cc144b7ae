#include "server/report/scale.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace stagger::server {
namespace {

constexpr const char* minus = "\u2212";

/// std::to_chars, unlike streams, knows no locale.
std::string to_fixed(double value, int decimals) {
  std::array<char, 512> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, decimals);
  std::string text(buffer.data(), end.ptr);
  // What rounds to zero has no sign.
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string with_minus_sign(std::string text) {
  if (text.starts_with('-')) text.replace(0, 1, minus);
  return text;
}

std::string superscript(int power) {
  constexpr std::array<const char*, 10> digits{"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                               "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = power < 0 ? "\u207b" : "";
  for (const char digit : std::to_string(std::abs(power))) {
    text += digits[static_cast<std::size_t>(digit - '0')];
  }
  return text;
}

}  // namespace

Range usable(const Range& range) {
  if (!std::isfinite(range.low) || !std::isfinite(range.high)) return {0.0, 1.0};
  const Range ordered{std::min(range.low, range.high), std::max(range.low, range.high)};
  const double size = std::max({std::abs(ordered.low), std::abs(ordered.high), 1e-300});
  // Narrower than this and neighbouring ticks would have the same digits.
  if (ordered.span() > 1e-9 * size) return ordered;
  const double half = ordered.low == 0.0 && ordered.high == 0.0 ? 1.0 : 0.5 * size;
  return {ordered.low - half, ordered.high + half};
}

Ticks nice_ticks(const Range& range, int most) {
  const Range r = usable(range);
  const double rough = r.span() / std::max(most, 2);
  const double power = std::floor(std::log10(rough));
  Ticks ticks;
  // Rounding of the logarithm may cost the first candidates; the last one is always enough.
  for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    ticks.step = factor * std::pow(10.0, power);
    ticks.decimals = std::clamp(-static_cast<int>(power) - (factor >= 10.0 ? 1 : 0), 0, 30);
    const double first = std::ceil(r.low / ticks.step - 1e-9);
    const double last = std::floor(r.high / ticks.step + 1e-9);
    if (last - first + 1.0 > std::max(most, 2)) continue;
    for (double i = first; i <= last; i += 1.0) ticks.values.push_back(i * ticks.step);
    break;
  }
  return ticks;
}

Range nice_range(const Range& range, int most) {
  const Range r = usable(range);
  const double step = nice_ticks(r, most).step;
  return {std::floor(r.low / step + 1e-9) * step, std::ceil(r.high / step - 1e-9) * step};
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "\u2014";
  return with_minus_sign(to_fixed(value, decimals));
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "\u2014";
  if (value == 0.0) return "0";
  const int power = static_cast<int>(std::floor(std::log10(std::abs(value))));
  if (power >= -4 && power < 6) return fixed(value, std::max(0, digits - 1 - power));
  const double mantissa = value / std::pow(10.0, power);
  return fixed(mantissa, std::max(0, digits - 1)) + " \u00d7 10" + superscript(power);
}

std::string coordinate(double value, int decimals) {
  std::string text = to_fixed(std::isfinite(value) ? value : 0.0, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
  }
  return text;
}

}  // namespace stagger::server
