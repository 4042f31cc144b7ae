// The rectangle that a foot stands on, from its collision geometry.
#pragma once

#include <Eigen/Geometry>

#include "sim/robot/robot_model.h"

namespace stagger::sim {

struct FoundSole {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the body's frame: x ahead, z up
  double length = 0.0;                                     ///< along x [m]
  double width = 0.0;                                      ///< along y [m]
  double tilt = 0.0;  ///< of the sole's plane from level at the zero pose [rad]
};

/// Looks for the flat underside of a foot: of all planes that touch the body's geometry from below,
/// tilted by 0.7 rad at most from what is level in `axes`, the one with the greatest area of
/// contact. The sole is the greatest rectangle inside this area that looks ahead, or along an edge
/// within 0.5 rad of that. `axes`: forward, left, up in the body's frame, at the zero pose. Throws
/// CannotWalk: no geometry, or less than 2 cm long or wide.
FoundSole find_sole(const Body& foot, const Eigen::Matrix3d& axes);

}  // namespace stagger::sim
