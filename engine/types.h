// Words that the whole engine is written in: sides, poses, states.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace stagger::engine {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// Which leg. The value is the index into every per-foot array.
enum class Side : std::uint8_t { left = 0, right = 1 };

constexpr std::size_t index(Side side) { return static_cast<std::size_t>(side); }
constexpr Side other(Side side) { return side == Side::left ? Side::right : Side::left; }
/// +1 for left, -1 for right: the sign of the lateral direction from the mid-line to that foot.
constexpr double lateral_sign(Side side) { return side == Side::left ? 1.0 : -1.0; }

/// One value for each foot, indexed by Side.
template <typename T>
using PerFoot = std::array<T, 2>;

/// Pose of the centre of a foot's sole: position in the world [m], yaw about world z [rad].
struct FootPose {
  Vec3 position = Vec3::Zero();
  double yaw = 0.0;
};

/// A place to step on: centre of the sole on the ground [m], yaw [rad], and the foot that goes
/// there.
struct Footstep {
  Vec2 position = Vec2::Zero();
  double yaw = 0.0;
  Side side = Side::left;
};

/// The four states of the paper's walking state machine (section III-A).
enum class WalkingState : std::uint8_t { idle, initialize, single_support, double_support };

/// z of the cross product of two vectors of the ground plane: positive when b is to the left of a.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Rotates a vector of the ground plane by an angle [rad].
inline Vec2 rotated(const Vec2& v, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

}  // namespace stagger::engine
