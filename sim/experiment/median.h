// What half of the runs reach.
#pragma once

#include <algorithm>
#include <vector>

namespace stagger::sim {

/// Of at least one value; the mean of the middle two when their number is even.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace stagger::sim
