// What statics say about a biped: how it may walk, and what its motors must hold.
#pragma once

#include "sim/robot/biped_finder.h"

namespace stagger::sim {

/// Motor limits for joints whose URDF gives none or none that can be true: no effort, more than
/// 1000 N m, or more than ten times weight times leg length. The assumption that replaces them is
/// the strength of the robot `kasaei` for its weight and legs. Tells what it assumed.
std::map<std::string, MotorLimits> assumed_motors(const RobotModel& model, const Legs& legs,
                                                  Quirks& quirks);

BipedFigures figures_of(const Robot& robot, const Legs& legs, const StandingPose& pose);

/// Joints that cannot hold the robot on one leg, ankles that cannot use their sole.
Quirks weaknesses(const BipedFigures& figures, const Robot& robot);

}  // namespace stagger::sim
