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

/// A foot farther off than this many deviations has slipped.
constexpr double slip_gate = 4.0;

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
    : noise_(noise), dt_(dt), gravity_(gravity), orientation_(orientation), origin_(start) {
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
  orientation_ = (orientation_ * rotation_by(dt_ * omega)).normalized();
  move_errors(rotation, velocity_);
  position_ += dt_ * (velocity_ + 0.5 * change);
  velocity_ += change;
}

void ContactFilter::move_errors(const Eigen::Matrix3d& rotation, const Vec3& velocity) {
  Covariance& p = covariance_;
  // P <- F P F' by rows and then by columns, each from old ones:
  //   e' = e - dt R b_gyro                     x' = x - dt x cross R b_gyro, x the feet,
  //   x' = x + dt v - dt x cross R b_gyro, x the position,
  //   v' = v + dt g cross e - dt R b_accelerometer - dt v cross R b_gyro.
  const Eigen::Matrix3d turned = dt_ * rotation;
  const double fall = dt_ * gravity_;
  {
    const Eigen::Matrix<double, 3, states> turning = turned * p.middleRows<3>(gyro_at);
    const auto cross = [&](int at, const Vec3& x) {
      p.row(at) -= x.y() * turning.row(2) - x.z() * turning.row(1);
      p.row(at + 1) -= x.z() * turning.row(0) - x.x() * turning.row(2);
      p.row(at + 2) -= x.x() * turning.row(1) - x.y() * turning.row(0);
    };
    p.middleRows<3>(position_at).noalias() += dt_ * p.middleRows<3>(velocity_at);
    p.row(velocity_at) += fall * p.row(turn_at + 1);
    p.row(velocity_at + 1) -= fall * p.row(turn_at);
    p.middleRows<3>(velocity_at).noalias() -= turned * p.middleRows<3>(accelerometer_at);
    cross(velocity_at, velocity);
    cross(position_at, position_);
    cross(place_of(0), feet_[0]);
    cross(place_of(1), feet_[1]);
    p.middleRows<3>(turn_at) -= turning;
  }
  {
    const Eigen::Matrix<double, states, 3> turning = p.middleCols<3>(gyro_at) * turned.transpose();
    const auto cross = [&](int at, const Vec3& x) {
      p.col(at) -= x.y() * turning.col(2) - x.z() * turning.col(1);
      p.col(at + 1) -= x.z() * turning.col(0) - x.x() * turning.col(2);
      p.col(at + 2) -= x.x() * turning.col(1) - x.y() * turning.col(0);
    };
    p.middleCols<3>(position_at).noalias() += dt_ * p.middleCols<3>(velocity_at);
    p.col(velocity_at) += fall * p.col(turn_at + 1);
    p.col(velocity_at + 1) -= fall * p.col(turn_at);
    p.middleCols<3>(velocity_at).noalias() -=
        p.middleCols<3>(accelerometer_at) * turned.transpose();
    cross(velocity_at, velocity);
    cross(position_at, position_);
    cross(place_of(0), feet_[0]);
    cross(place_of(1), feet_[1]);
    p.middleCols<3>(turn_at) -= turning;
  }
  // A reading's noise acts as its bias does, for one tick.
  Eigen::Matrix<double, states, 3> turning = Eigen::Matrix<double, states, 3>::Zero();
  const double angle = dt_ * noise_.gyro;
  turning.middleRows<3>(turn_at).diagonal().setConstant(angle);
  turning.middleRows<3>(velocity_at) = cross_matrix(angle * velocity);
  turning.middleRows<3>(position_at) = cross_matrix(angle * position_);
  turning.middleRows<3>(place_of(0)) = cross_matrix(angle * feet_[0]);
  turning.middleRows<3>(place_of(1)) = cross_matrix(angle * feet_[1]);
  p.noalias() += turning * turning.transpose();
  const auto grow = [&p](int at, double variance) {
    p.diagonal().segment<3>(at).array() += variance;
  };
  grow(velocity_at, squared(dt_ * noise_.accelerometer));
  grow(gyro_at, dt_ * squared(noise_.gyro_walk));
  grow(accelerometer_at, dt_ * squared(noise_.accelerometer_walk));
  // What rounding makes of it grows with the yaw, which nothing observes: after a minute or two of
  // walking an unsymmetric covariance would bring the filter down.
  p = (0.5 * (p + p.transpose())).eval();
}

void ContactFilter::recentre() {
  const Vec3 way = position_;
  origin_ += way;
  position_.setZero();
  for (Vec3& foot : feet_) foot -= way;
  // What the yaw of the world does to a place depends on where the world's origin is.
  Covariance& p = covariance_;
  const Eigen::Matrix3d cross = cross_matrix(way);
  for (const int at : {position_at, place_of(0), place_of(1)}) {
    p.middleRows<3>(at) -= cross * p.middleRows<3>(turn_at);
  }
  for (const int at : {position_at, place_of(0), place_of(1)}) {
    p.middleCols<3>(at) -= p.middleCols<3>(turn_at) * cross.transpose();
  }
  // Nothing observes where the base is and which way it looks: from here on both are right by
  // definition of the world, and what was unsure about them is its drift. What is left is how the
  // feet stand to the base. Else the variance of the drift would grow with the way, and drown that.
  for (const int at : {place_of(0), place_of(1)}) {
    p.middleRows<3>(at) -= p.middleRows<3>(position_at);
  }
  for (const int at : {place_of(0), place_of(1)}) {
    p.middleCols<3>(at) -= p.middleCols<3>(position_at);
  }
  p.middleRows<3>(position_at).setZero();
  p.middleCols<3>(position_at).setZero();
  p.row(turn_at + 2).setZero();
  p.col(turn_at + 2).setZero();
}

void ContactFilter::plant(std::size_t foot, const Vec3& in_base) {
  recentre();  // now and then: far from the origin the difference of two places would lose digits
  feet_[foot] = position_ + orientation_ * in_base;
  stands_[foot] = true;
  // d = p + R r: its invariant error is that of p.
  const int at = place_of(foot);
  Covariance& p = covariance_;
  p.middleRows<3>(at) = p.middleRows<3>(position_at);
  p.middleCols<3>(at) = p.middleCols<3>(position_at);
  p.diagonal().segment<3>(at).array() += squared(noise_.leg);
}

void ContactFilter::shift(std::size_t foot, const Vec3& way, double deviation) {
  feet_[foot] += way;
  covariance_.diagonal().segment<3>(place_of(foot)).array() += squared(deviation);
}

void ContactFilter::see(std::size_t foot, const Vec3& in_base) {
  const int at = place_of(foot);
  Covariance& p = covariance_;
  // d - p - R r is what the error of p is more than that of d.
  const Vec3 residual = feet_[foot] - position_ - orientation_ * in_base;
  const double variance = squared(noise_.leg);
  double total = 3.0 * variance;
  for (int i = 0; i < 3; ++i) {
    total +=
        p(position_at + i, position_at + i) - 2.0 * p(position_at + i, at + i) + p(at + i, at + i);
  }
  if (residual.squaredNorm() > squared(slip_gate) * total) {
    p.diagonal().segment<3>(at).array() += residual.squaredNorm();
  }
  State correction = State::Zero();
  for (int i = 0; i < 3; ++i) {
    const State spread = p.col(position_at + i) - p.col(at + i);
    const double expected = correction[position_at + i] - correction[at + i];
    const double sum = spread[position_at + i] - spread[at + i] + variance;
    correction += ((residual[i] - expected) / sum) * spread;
    const State scaled = spread / std::sqrt(sum);
    p.noalias() -= scaled * scaled.transpose();
  }
  take(correction);
}

void ContactFilter::take(const State& correction) {
  const Eigen::Quaterniond turn = rotation_by(correction.segment<3>(turn_at));
  orientation_ = (turn * orientation_).normalized();
  velocity_ = turn * velocity_ + correction.segment<3>(velocity_at);
  position_ = turn * position_ + correction.segment<3>(position_at);
  gyro_bias_ += correction.segment<3>(gyro_at);
  accelerometer_bias_ += correction.segment<3>(accelerometer_at);
  for (std::size_t foot = 0; foot < 2; ++foot) {
    feet_[foot] = turn * feet_[foot] + correction.segment<3>(place_of(foot));
  }
}

}  // namespace stagger::sim
