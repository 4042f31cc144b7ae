// Sums of rigid bodies, and bodies whose file does not say what they weigh.
#pragma once

#include "sim/robot/quirk.h"
#include "sim/robot/robot_model.h"

namespace stagger::sim {

/// Adds a piece (inertia about its own centre of mass, axes of the body's frame) to a body.
void add_mass(Body& body, double mass, const Vec3& com, const Eigen::Matrix3d& inertia);

/// Empty when a rigid body can have this inertia: principal moments above 0, none of them greater
/// than the sum of the other two (by 1e-3 of itself, for rounded figures). Else what is wrong.
std::string inertia_fault(const Eigen::Matrix3d& inertia);

/// Makes every body one that moves: without mass it gets a thousandth of the robot's, and an
/// inertia that no body has is replaced by the nearest that a cube of water of its mass and the
/// triangle inequality allow. Tells what it did. Does nothing to a robot without any mass.
Quirks mend_masses(RobotModel& model);

}  // namespace stagger::sim
