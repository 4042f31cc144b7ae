// What the parts of a tick are tested with.
#pragma once

namespace stagger::sim {

inline constexpr double dt = 0.001;      // [s]
inline constexpr double gravity = 9.81;  // [m/s^2]

}  // namespace stagger::sim
