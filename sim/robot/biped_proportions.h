// The lengths of a biped's legs, found from its joints.
#pragma once

#include <vector>

#include "sim/robot/robot.h"

namespace stagger::sim {

/// What a gait has to fit, in the nominal pose.
struct BipedProportions {
  double com_height = 0.0;    ///< above the soles [m]
  double leg_length = 0.0;    ///< hip to ankle with a straight knee [m]
  double hip_height = 0.0;    ///< of the hip above the ankle [m]
  double sole_width = 0.0;    ///< [m]
  double stance_width = 0.0;  ///< between the soles' centres [m]
};

/// Bodies of one leg from the hip down: those that carry this foot but not the other one.
std::vector<int> leg_bodies(const Robot& robot, engine::Side side);

/// Of the left leg, in the robot's nominal pose. Hip, knee and ankle are where the axes that lie
/// sideways are; of a leg with fewer than two of those the length is the height of its first joint
/// above its last one.
BipedProportions biped_proportions(const Robot& robot);

/// How far the ankles' torque moves the ZMP of the robot standing on one foot: the greatest
/// distance from the sole's centre, along its length and width, that both feet reach to either side
/// [m]. Beyond the sole's edge where the ankle is strong; never less than 0. With tau the joint's
/// effort and a the ankle's place over the sole it reaches tau / (m g) either side of a: of an
/// ankle that is not over the centre only the shorter way counts, since the engine's soles are
/// symmetric.
engine::Vec2 ankle_zmp_reach(const Robot& robot, double gravity);

}  // namespace stagger::sim
