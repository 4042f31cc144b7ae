// Any biped URDF in, a description and figures out.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sim/robot/biped_legs.h"
#include "sim/robot/biped_pose.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

/// What a joint needs to hold all of the robot's weight on its leg, in the nominal pose.
struct HoldingTorque {
  std::string joint;
  double needed = 0.0;  ///< [N m]
  double limit = 0.0;   ///< [N m]
};

/// Statics in the nominal pose. Ankle figures: how far the ZMP gets from the ankle in single
/// support: the sole's edge or the joint's torque limit over m g, whichever comes first.
struct BipedFigures {
  double mass = 0.0;          ///< [kg]
  double com_height = 0.0;    ///< above the soles [m]
  double omega = 0.0;         ///< sqrt(g / com_height) [1/s]
  double leg_length = 0.0;    ///< hip to ankle, knee straight [m]
  double leg_share = 0.0;     ///< of that, in the nominal pose
  double stance_width = 0.0;  ///< [m]
  double ankle_ahead = 0.0;   ///< [m]
  double ankle_behind = 0.0;  ///< [m]
  double ankle_inward = 0.0;  ///< towards the other foot; 0 without an ankle roll joint [m]
  double ankle_outward = 0.0;
  std::vector<HoldingTorque> holding;  ///< of the left leg's hip and knee joints
};

struct BipedFinding {
  std::filesystem::path urdf;
  Robot robot;  ///< its description is complete; its folder is the URDF's
  Legs legs;
  BipedFigures figures;
  Quirks quirks;
  std::map<std::string, std::filesystem::path> meshes;  ///< collision meshes: URI -> file
};

/// Finds base, legs, feet, soles, torso and a nominal pose, and proposes how to walk. Throws
/// CannotWalk with the reason for a robot that this program cannot walk with, std::runtime_error
/// for a file that is no URDF of a tree of links.
BipedFinding find_biped(const std::filesystem::path& urdf);

}  // namespace stagger::sim
