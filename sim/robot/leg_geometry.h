// What of a leg decides how far it reaches: hip, knee and ankle, whatever the order of its joints.
#pragma once

#include <vector>

#include "sim/robot/robot.h"

namespace stagger::sim {

/// One leg, found from the model: the three joints whose axes point sideways in the nominal pose
/// are hip pitch, knee and ankle pitch; the first whose axis points forward is the hip's roll.
struct LegGeometry {
  std::vector<int> bodies;  ///< from the hip down; bodies[i] is carried by the leg's i-th joint
  int hip_body = -1;        ///< its frame's origin lies on the hip's pitch axis; -1: not found
  int hip_roll_body = -1;
  int knee_body = -1;
  int ankle_body = -1;  ///< its frame's origin lies on the ankle's pitch axis
  double length = 0.0;  ///< greatest distance between those two origins that the knee allows [m]
};

/// The leg of that side. Without three such joints the three bodies are -1 and the length is 0.
LegGeometry leg_geometry(const Robot& robot, engine::Side side);

}  // namespace stagger::sim
