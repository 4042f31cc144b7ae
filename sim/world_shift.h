// The world of a state estimate drifts: where it lies in the true one.
#pragma once

#include "engine/types.h"

namespace stagger::sim {

/// A turn about the vertical through the origin, then a shift. Of nothing when the estimate has not
/// drifted: then it changes no bit.
struct WorldShift {
  engine::Vec3 shift = engine::Vec3::Zero();  ///< [m]
  double yaw = 0.0;                           ///< [rad]

  /// The shift that brings a foot from where it is thought to be to where it is.
  static WorldShift between(const engine::FootPose& thought, const engine::FootPose& truth) {
    WorldShift result;
    result.yaw = std::remainder(truth.yaw - thought.yaw, two_pi);
    result.shift.head<2>() =
        truth.position.head<2>() - engine::rotated(thought.position.head<2>(), result.yaw);
    result.shift.z() = truth.position.z() - thought.position.z();
    return result;
  }

  /// The way back.
  WorldShift inverse() const {
    WorldShift result;
    result.yaw = -yaw;
    result.shift.head<2>() = -engine::rotated(engine::Vec2(shift.head<2>()), -yaw);
    result.shift.z() = -shift.z();
    return result;
  }

  engine::Vec2 applied_to(const engine::Vec2& point) const {
    return engine::rotated(point, yaw) + shift.head<2>();
  }
  engine::Vec3 applied_to(const engine::Vec3& point) const {
    engine::Vec3 result;
    result.head<2>() = applied_to(engine::Vec2(point.head<2>()));
    result.z() = point.z() + shift.z();
    return result;
  }
  engine::FootPose applied_to(const engine::FootPose& pose) const {
    return {applied_to(pose.position), pose.yaw + yaw};
  }
  engine::Footstep applied_to(const engine::Footstep& step) const {
    return {applied_to(step.position), step.yaw + yaw, step.side};
  }

 private:
  static constexpr double two_pi = 6.283185307179586;
};

}  // namespace stagger::sim
