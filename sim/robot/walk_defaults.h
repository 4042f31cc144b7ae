// How a robot walks when its description does not say: by formula, from its proportions.
#pragma once

#include "sim/robot/robot.h"

namespace stagger::sim {

/// What a gait has to fit, in the posture that the robot walks in.
struct BipedProportions {
  double com_height = 0.0;    ///< above the soles [m]
  double leg_length = 0.0;    ///< hip to ankle with a straight knee [m]
  double hip_height = 0.0;    ///< of the hips above the ankles [m]
  double sole_width = 0.0;    ///< [m]
  double stance_width = 0.0;  ///< between the soles' centres [m]
};

/// The hips of a walking robot are at most this share of its legs' length above the ankles: those
/// of robot kasaei, in the nominal pose. Legs that can still lengthen take larger pushes.
inline constexpr double walking_hip_share = 0.84;

/// Measured with the hips at walking_hip_share, or in the nominal pose if that is lower.
BipedProportions biped_proportions(const Robot& robot);

/// Durations are those of the reference robot (0.40 s single, 0.10 s double support at h = 1 m) in
/// units of sqrt(h / g); lengths are shares of the leg's length. Each constant's comment in the
/// source names what chose it.
WalkDescription walk_defaults(const BipedProportions& proportions);

}  // namespace stagger::sim
