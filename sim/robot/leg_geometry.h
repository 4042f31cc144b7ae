// What of a leg decides how far it reaches: hip, knee and ankle, whatever the order of its joints.
#pragma once

#include <vector>

#include "sim/robot/robot.h"

namespace stagger::sim {

/// One leg, found from the model: the three joints that turn about the lateral axis in the nominal
/// pose are hip pitch, knee and ankle pitch; the first that turns about the forward one is the
/// hip's roll. The bodies are those that these joints carry.
struct LegGeometry {
  int hip_body = -1;  ///< its frame's origin lies on the hip's pitch axis; -1: not found
  int hip_roll_body = -1;
  /// Index of joints; -1: not found, or so straight in the nominal pose that it tells no way.
  int knee_joint = -1;
  double straight_knee = 0.0;     ///< its angle at which the leg is longest [rad]
  double knee_way = 1.0;          ///< 1 if the knee bends to greater angles from there, else -1
  int ankle_body = -1;            ///< its frame's origin lies on the ankle's pitch axis
  std::vector<int> ankle_joints;  ///< those below the knee, as indices of joints
  double length = 0.0;  ///< between those two origins with a straight knee [m]; 0: not found
};

/// The leg of that side. Without three such joints there are no bodies and the length is 0.
LegGeometry leg_geometry(const Robot& robot, engine::Side side);

}  // namespace stagger::sim
