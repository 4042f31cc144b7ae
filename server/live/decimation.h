// Which ticks a client is told of.
#pragma once

#include <cmath>
#include <cstdint>

namespace stagger::server {

/// True for one tick in each 1/rate of simulation time. It depends on nothing but the tick, so that
/// two clients of the same rate are told of the same ticks.
inline bool is_due(std::uint64_t tick, double rate_hz, double tick_s) {
  // Ticks a second as a whole number: dividing by it is exact where multiplying by 0.001 is not.
  const double ticks_per_second = std::round(1.0 / tick_s);
  const auto period = [&](std::uint64_t t) {
    return std::floor(static_cast<double>(t) * rate_hz / ticks_per_second);
  };
  return tick == 0 || period(tick) != period(tick - 1);
}

}  // namespace stagger::server
