// The points that collision geometry can touch the ground with.
#pragma once

#include <vector>

#include "sim/robot/robot_model.h"

namespace stagger::sim {

/// Points of all shapes, as `pose` puts them: corners of boxes, points of hulls, rims of cylinders
/// that stand, and of whatever is round its lowest points against `up`. Their lowest is the shapes'
/// lowest.
std::vector<Vec3> support_points(const std::vector<Shape>& shapes, const Eigen::Isometry3d& pose,
                                 const Vec3& up);

}  // namespace stagger::sim
