// Of a CoM at 1 m on Earth.
#pragma once

#include <cmath>

namespace stagger::engine {

inline const double omega = std::sqrt(9.81);  // [1/s]

}  // namespace stagger::engine
