// What goes into the engine: the state of the robot as its sensors and estimator tell it.
#pragma once

#include "engine/types.h"

namespace stagger::engine {

/// One measurement, in the world frame. Whether it is noisy or perfect is the plant's business.
struct Measurement {
  Vec3 com = Vec3::Zero();           ///< centre of mass [m]
  Vec3 com_velocity = Vec3::Zero();  ///< velocity of the centre of mass [m/s]
  Vec2 zmp = Vec2::Zero();      ///< zero moment point on the ground [m]; kept while no foot loads
  PerFoot<FootPose> feet;       ///< pose of each sole
  PerFoot<double> foot_load{};  ///< normal force under each foot [N]
};

/// Written so that a NaN is none.
inline bool plausible(double value) {
  constexpr double most = 1e6;
  return std::abs(value) <= most;
}
inline bool plausible(const Vec3& v) {
  return plausible(v.x()) && plausible(v.y()) && plausible(v.z());
}
inline bool plausible(const FootPose& pose) {
  return plausible(pose.position) && plausible(pose.yaw);
}

/// Throws std::invalid_argument when an engine cannot start from this.
void validate(const Measurement& start);

}  // namespace stagger::engine
