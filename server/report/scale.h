// Ticks that people can read, and numbers as text that is the same on every machine.
#pragma once

#include <string>
#include <vector>

namespace stagger::server {

struct Range {
  double low = 0.0;
  double high = 1.0;
  double span() const { return high - low; }
};

struct Ticks {
  std::vector<double> values;  ///< multiples of the step inside the range, rising
  double step = 1.0;           ///< 1, 2 or 5 times a power of ten
  int decimals = 0;            ///< enough for the step
};

/// At most `most` ticks (2 or more) for a range; a range that is empty or not finite is widened or
/// replaced first, as by `usable`.
Ticks nice_ticks(const Range& range, int most);
/// The range itself where it can be drawn; else one around it that can.
Range usable(const Range& range);
/// Grown to the ticks next to its ends.
Range nice_range(const Range& range, int most);

/// Fixed notation with U+2212 as the minus sign; no negative zero.
std::string fixed(double value, int decimals);
/// About `digits` significant digits, in fixed notation where that is short and as "1.2 × 10^-7"
/// (the power in superscript) where it is not.
std::string significant(double value, int digits);
/// For SVG: at most `decimals` decimals, no trailing zeros, an ASCII minus.
std::string coordinate(double value, int decimals = 1);

/// Where a value of `from` lies in `to`.
class LinearScale {
 public:
  LinearScale(const Range& from, const Range& to)
      : factor_(to.span() / from.span()), offset_(to.low - factor_ * from.low) {}
  double operator()(double value) const { return factor_ * value + offset_; }
  double factor() const { return factor_; }

 private:
  double factor_;
  double offset_;
};

}  // namespace stagger::server
