// What a robot with a body knows of itself: perfect knowledge, or sensors and an estimator.
#pragma once

#include "sim/control/sensors.h"

namespace stagger::sim {

/// For the full body; the pendulum has noise and delay of its own.
struct SenseParameters {
  bool perfect_state = false;  ///< control reads the physics' state; else sensors and an estimator
  double control_delay = 0.001;  ///< from a measurement to the torque made from it, 0 to 0.01 [s]
  SensorParameters sensors;      ///< without effect when the state is perfect
  bool operator==(const SenseParameters&) const = default;
};

/// Greatest delay [s].
inline constexpr double max_control_delay = 0.01;

/// Throws std::invalid_argument, naming field, value and allowed range, at the first value that is
/// not finite or out of its range.
void validate(const SenseParameters& parameters);

}  // namespace stagger::sim
