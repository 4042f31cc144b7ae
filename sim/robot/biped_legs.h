// Which joints of an unknown robot are its legs, and which way it looks.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/robot/urdf_import.h"

namespace stagger::sim {

/// What cannot walk here: the text says why.
class CannotWalk : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class LegRole : std::uint8_t {
  hip_yaw,
  hip_roll,
  hip_pitch,
  knee,
  ankle_yaw,
  ankle_roll,
  ankle_pitch
};
const char* name(LegRole role);
inline bool is_hip(LegRole role) { return role < LegRole::knee; }
inline bool is_ankle(LegRole role) { return role > LegRole::knee; }

struct LegJoint {
  std::string name;
  LegRole role = LegRole::knee;
  engine::Vec3 axis = engine::Vec3::Zero();  ///< at the zero pose: parts along forward, left, up
};

struct Leg {
  std::vector<LegJoint> joints;               ///< from the hip to the foot
  std::string foot;                           ///< link that the last joint carries
  engine::Vec3 hip = engine::Vec3::Zero();    ///< where the hip's axes meet (nearly), zero pose [m]
  engine::Vec3 knee = engine::Vec3::Zero();   ///< on the knee's axis [m]
  engine::Vec3 ankle = engine::Vec3::Zero();  ///< where the ankle's axes meet (nearly) [m]

  /// Hip to ankle with the knee straight [m].
  double length() const { return (knee - hip).norm() + (ankle - knee).norm(); }
  bool has(LegRole role) const;
};

/// Points and axes are in the root link's frame, with all joints at zero.
struct Legs {
  std::string base;  ///< link that both legs hang off
  engine::PerFoot<Leg> leg;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: forward, left, up
  std::vector<std::string> locked;  ///< joints that are part of neither leg, or cannot be used
  Quirks quirks;
};

/// Finds the legs of a surveyed model: the two lowest ends of the tree, and the chains up to the
/// body where they meet. Up is the root's z axis. A joint's role comes from its axis in the world
/// and from its place in the chain, never from its name or from the axis as written. Left and right
/// come from the names, else from the way the knees bend, else forward is the root's x.
/// Throws CannotWalk.
Legs find_legs(const RobotModel& model, const ImportReport& report);

}  // namespace stagger::sim
