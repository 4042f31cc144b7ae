// A pose that an unknown biped can stand in.
#pragma once

#include "sim/robot/biped_legs.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

struct StandingPose {
  std::map<std::string, double> joints;  ///< every leg joint [rad]
  double leg_share = 0.0;     ///< distance from hip to ankle, of the straight leg's length
  double com_height = 0.0;    ///< above the soles [m]
  double stance_width = 0.0;  ///< between the soles' centres [m]
};

/// Standing on both soles, level and at one height, toes ahead, torso upright, CoM over the middle
/// between the soles; hip and ankle as far apart as 0.96 of the leg's length, or less when the
/// joint limits want it. Damped least squares on the Jacobians: nothing is assumed of the joints'
/// order or axes. `robot` has its feet described; `legs` was found in the same URDF. Throws
/// CannotWalk when there is no such pose within the joint limits.
StandingPose find_standing_pose(const Robot& robot, const Legs& legs);

}  // namespace stagger::sim
