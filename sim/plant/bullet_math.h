// From Eigen's types to Bullet's and back.
#pragma once

#include <LinearMath/btTransform.h>

#include <Eigen/Geometry>

#include "engine/types.h"

namespace stagger::sim {

inline btVector3 to_bullet(const engine::Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline btQuaternion to_bullet(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline btTransform to_bullet(const Eigen::Isometry3d& pose) {
  return btTransform(to_bullet(Eigen::Quaterniond(pose.linear())),
                     to_bullet(engine::Vec3(pose.translation())));
}

inline engine::Vec3 to_eigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Quaterniond to_eigen(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

}  // namespace stagger::sim
