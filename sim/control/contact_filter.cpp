#include "sim/control/contact_filter.h"

#include <cmath>

namespace stagger::sim {
namespace {

// Where each error begins.
constexpr int turn_at = 0;
constexpr int velocity_at = 3;
constexpr int position_at = 6;
constexpr int gyro_at = 9;
constexpr int accelerometer_at = 12;
constexpr int first_foot = 15;

constexpr int place_of(std::size_t foot) { return first_foot + 3 * static_cast<int>(foot); }

Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond rotation_by(const Vec3& vector) {
  const double angle = vector.norm();
  // Half the sine over the angle; the series is exact to the last bit below that angle.
  const double scale = angle > 1e-4 ? std::sin(0.5 * angle) / angle : 0.5 - angle * angle / 48.0;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = scale * vector;
  return q;
}

double squared(double x) { return x * x; }

}  // namespace

ContactFilter::ContactFilter(const ContactFilterNoise& noise, double dt, double gravity,
                             const Vec3& start, const Eigen::Quaterniond& orientation)
    : noise_(noise), dt_(dt), gravity_(gravity), orientation_(orientation), position_(start) {
  const auto set = [this](int at, double deviation) {
    covariance_.diagonal().segment<3>(at).setConstant(squared(deviation));
  };
  set(turn_at, noise.start_tilt);
  covariance_(turn_at + 2, turn_at + 2) = 0.0;  // the start defines where x points, and the origin
  set(velocity_at, noise.start_velocity);
  set(gyro_at, noise.gyro_bias);
  set(accelerometer_at, noise.accelerometer_bias);
}

void ContactFilter::predict(const Vec3& measured_velocity, const Vec3& measured_force) {
  const Vec3 omega = measured_velocity - gyro_bias_;
  const Vec3 force = measured_force - accelerometer_bias_;
  const Eigen::Quaterniond middle = orientation_ * rotation_by(0.5 * dt_ * omega);
  const Eigen::Matrix3d rotation = middle.toRotationMatrix();
  const Vec3 force_in_world = rotation * force;
  const Vec3 change = dt_ * (force_in_world - Vec3(0.0, 0.0, gravity_));
  angular_velocity_ = rotation * omega;
  position_ += dt_ * (velocity_ + 0.5 * change);
  velocity_ += change;
  orientation_ = (orientation_ * rotation_by(dt_ * omega)).normalized();

  // P <- F P F', F = 1 but for three rows of blocks; from the last of them to be used on.
  Covariance& p = covariance_;
  const Eigen::Matrix3d tilting = dt_ * cross_matrix(force_in_world);
  const Eigen::Matrix3d turned = dt_ * rotation;
  p.middleRows<3>(position_at).noalias() += dt_ * p.middleRows<3>(velocity_at);
  p.middleRows<3>(velocity_at).noalias() -= tilting * p.middleRows<3>(turn_at);
  p.middleRows<3>(velocity_at).noalias() -= turned * p.middleRows<3>(accelerometer_at);
  p.middleRows<3>(turn_at).noalias() -= turned * p.middleRows<3>(gyro_at);
  p.middleCols<3>(position_at).noalias() += dt_ * p.middleCols<3>(velocity_at);
  p.middleCols<3>(velocity_at).noalias() -= p.middleCols<3>(turn_at) * tilting.transpose();
  p.middleCols<3>(velocity_at).noalias() -= p.middleCols<3>(accelerometer_at) * turned.transpose();
  p.middleCols<3>(turn_at).noalias() -= p.middleCols<3>(gyro_at) * turned.transpose();
  const auto grow = [&](int at, double density) {
    p.diagonal().segment<3>(at).array() += squared(density) * dt_;
  };
  grow(turn_at, noise_.gyro);
  grow(velocity_at, noise_.accelerometer);
  grow(gyro_at, noise_.gyro_walk);
  grow(accelerometer_at, noise_.accelerometer_walk);
}

void ContactFilter::plant(std::size_t foot, const Vec3& in_base) {
  const Vec3 arm = orientation_ * in_base;
  feet_[foot] = position_ + arm;
  stands_[foot] = true;
  // d = p + R r, so its error is that of p less arm x that of R.
  const int at = place_of(foot);
  const Eigen::Matrix3d cross = cross_matrix(arm);
  Covariance& p = covariance_;
  p.middleRows<3>(at) = p.middleRows<3>(position_at) - cross * p.middleRows<3>(turn_at);
  p.block<3, 3>(at, at).setZero();
  const Eigen::Matrix3d own =
      p.block<3, 3>(at, position_at) - p.block<3, 3>(at, turn_at) * cross.transpose();
  p.middleCols<3>(at) = p.middleRows<3>(at).transpose();
  p.block<3, 3>(at, at) = 0.5 * (own + own.transpose());
  p.diagonal().segment<3>(at).array() += squared(noise_.leg);
}

void ContactFilter::shift(std::size_t foot, const Vec3& way, double deviation) {
  feet_[foot] += way;
  covariance_.diagonal().segment<3>(place_of(foot)).array() += squared(deviation);
}

void ContactFilter::see(std::size_t foot, const Vec3& in_base) {
  const int at = place_of(foot);
  const Vec3 arm = feet_[foot] - position_;
  // d - p - R r = 0; in errors: e_p - e_d + e_R x arm = what it amounts to now.
  const Vec3 residual = arm - orientation_ * in_base;
  const Eigen::Matrix3d cross = cross_matrix(arm);
  Covariance& p = covariance_;
  State correction = State::Zero();
  const double variance = squared(noise_.leg);
  for (int axis = 0; axis < 3; ++axis) {
    State spread = p.col(position_at + axis) - p.col(at + axis);
    // A row of a cross matrix has two entries.
    const int j = (axis + 1) % 3;
    const int k = (axis + 2) % 3;
    spread -= cross(axis, j) * p.col(turn_at + j) + cross(axis, k) * p.col(turn_at + k);
    const auto along = [&](const State& x) {
      return x[position_at + axis] - x[at + axis] - cross(axis, j) * x[turn_at + j] -
             cross(axis, k) * x[turn_at + k];
    };
    const double total = along(spread) + variance;
    correction += ((residual[axis] - along(correction)) / total) * spread;
    const State scaled = spread / std::sqrt(total);
    p.noalias() -= scaled * scaled.transpose();
  }
  take(correction);
}

void ContactFilter::take(const State& correction) {
  orientation_ = (rotation_by(correction.segment<3>(turn_at)) * orientation_).normalized();
  velocity_ += correction.segment<3>(velocity_at);
  position_ += correction.segment<3>(position_at);
  gyro_bias_ += correction.segment<3>(gyro_at);
  accelerometer_bias_ += correction.segment<3>(accelerometer_at);
  for (std::size_t foot = 0; foot < 2; ++foot) {
    if (stands_[foot]) feet_[foot] += correction.segment<3>(place_of(foot));
  }
}

}  // namespace stagger::sim
