// What the joints of a biped tell about its legs.
#pragma once

#include <vector>

#include "sim/robot/rigid_body.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

/// Bodies of one leg from the hip down: those that carry this foot but not the other one.
std::vector<int> leg_bodies(const Robot& robot, engine::Side side);

/// Those of them whose joints turn about that direction (unit, world), within 45 degrees. `body` is
/// up to date with the state that is meant.
std::vector<int> turning_about(const RigidBody& body, const Robot& robot, engine::Side side,
                               const Vec3& direction);

/// Centre of a sole, world [m].
Vec3 sole_centre(const RigidBody& body, const Robot& robot, engine::Side side);

/// Where the left leg's hip, knee and ankle turn forwards, from the hip down; of a leg with fewer
/// than two such joints all of it.
std::vector<int> leg_hinges(const RigidBody& body, const Robot& robot);

/// Hip to ankle of the left leg with a straight knee [m].
double leg_length(const RigidBody& body, const Robot& robot);

/// Its hip above its ankle [m].
double hip_height(const RigidBody& body, const Robot& robot);

/// How far the ankles' torque moves the ZMP of the robot standing on one foot: the greatest
/// distance from the sole's centre, along its length and width, that both feet reach to either side
/// [m]. Beyond the sole's edge where the ankle is strong; never less than 0. With tau the joint's
/// effort and a the ankle's place over the sole it reaches tau / (m g) either side of a: of an
/// ankle that is not over the centre only the shorter way counts, since the engine's soles are
/// symmetric.
engine::Vec2 ankle_zmp_reach(const Robot& robot, double gravity);

}  // namespace stagger::sim
