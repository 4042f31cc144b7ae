// How the numbers that were found on one robot carry over to another.
#pragma once

#include <cmath>

#include "sim/robot/robot.h"

namespace stagger::sim {

/// Ratios to the robot that the project's gains and margins were found on: 30 kg, CoM at 1 m. Two
/// pendulums of different size move alike when lengths scale with the height h of the CoM and times
/// with sqrt(h / g) (Froude scaling; Hof, Scaling gait data to body size, 1996). Accelerations then
/// do not scale at all: a limit in m/s^2 is one of so many g.
struct DynamicScale {
  double length = 1.0;  ///< of lengths and, with gravity the same everywhere, of squared times
  double mass = 1.0;    ///< of masses and forces

  double time() const { return std::sqrt(length); }
  double frequency() const { return 1.0 / time(); }
  /// Of a torque per angular velocity [N m s].
  double damping() const { return mass * length * time(); }
};

inline constexpr double reference_mass = 30.0;       // [kg]
inline constexpr double reference_com_height = 1.0;  // [m]

inline DynamicScale dynamic_scale(const Robot& robot) {
  return {robot.description.walk.com_height_m / reference_com_height,
          robot.model.mass() / reference_mass};
}

}  // namespace stagger::sim
