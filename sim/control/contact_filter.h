// The Kalman filter of a legged robot's base: an inertial unit, and feet that stay where they
// stand.
#pragma once

#include <Eigen/Geometry>

#include "engine/types.h"

namespace stagger::sim {

using engine::PerFoot;
using engine::Vec3;

/// Standard deviations, each axis.
struct ContactFilterNoise {
  double gyro = 0.0;                ///< of a reading [rad/s]
  double accelerometer = 0.0;       ///< of a reading [m/s^2]
  double gyro_walk = 0.0;           ///< of the bias, after one second [rad/s]
  double accelerometer_walk = 0.0;  ///< of the bias, after one second [m/s^2]
  double leg = 0.0;                 ///< of one look at a foot [m]
  double start_tilt = 0.0;          ///< [rad]
  double start_velocity = 0.0;      ///< [m/s]
  double gyro_bias = 0.0;           ///< [rad/s]
  double accelerometer_bias = 0.0;  ///< [m/s^2]
};

/// Error-state filter over the base's orientation, velocity, position, both biases and the place of
/// each foot that stands, with the right-invariant error (Hartley, Ghaffari, Eustice and Grizzle,
/// Contact-Aided Invariant Extended Kalman Filtering for Robot State Estimation, IJRR 2020): with R
/// off by the rotation e, a place or velocity x is off by exp(e) x - x besides its own error. In
/// these words nobody's yaw about the world's origin tells anything about a foot's place, whatever
/// the estimate, so a foot that slips cannot turn the whole world. World yaw and place are not
/// observable and drift; base and feet drift together. No heap.
class ContactFilter {
 public:
  ContactFilter(const ContactFilterNoise& noise, double dt, double gravity, const Vec3& position,
                const Eigen::Quaterniond& orientation);

  /// One tick with what the unit in the base's origin measured, base axes, mean over the tick:
  /// angular velocity [rad/s] and specific force [m/s^2].
  void predict(const Vec3& angular_velocity, const Vec3& specific_force);

  /// The foot stands from now on where it is seen: `in_base` is its place in the base's frame [m].
  void plant(std::size_t foot, const Vec3& in_base);
  /// It stands no more.
  void lift(std::size_t foot) { stands_[foot] = false; }
  bool stands(std::size_t foot) const { return stands_[foot]; }
  /// A foot that stands has moved by this much [m], and by something more that is not known, of
  /// this deviation in each axis [m].
  void shift(std::size_t foot, const Vec3& way, double deviation);
  /// The foot that stands is seen there, in the base's frame [m]. Where that cannot be, by more
  /// than a few deviations, the foot has slipped: then it is the foot that moves, not the base.
  void see(std::size_t foot, const Vec3& in_base);

  const Eigen::Quaterniond& orientation() const { return orientation_; }
  Vec3 position() const { return origin_ + position_; }
  const Vec3& velocity() const { return velocity_; }
  /// Mean over the last tick, world axes [rad/s].
  const Vec3& angular_velocity() const { return angular_velocity_; }
  const Vec3& gyro_bias() const { return gyro_bias_; }
  const Vec3& accelerometer_bias() const { return accelerometer_bias_; }
  Vec3 foot(std::size_t foot) const { return origin_ + feet_[foot]; }

  static constexpr int states = 21;
  using Covariance = Eigen::Matrix<double, states, states>;
  /// Of the errors [orientation, velocity, position, gyro bias, accelerometer bias, left foot,
  /// right foot], world axes but for the biases, about a point near the base. That of a foot in the
  /// air means nothing.
  const Covariance& covariance() const { return covariance_; }

 private:
  using State = Eigen::Matrix<double, states, 1>;
  void move_errors(const Eigen::Matrix3d& rotation, const Vec3& velocity);
  void recentre();
  void take(const State& correction);

  ContactFilterNoise noise_;
  double dt_;
  double gravity_;
  Eigen::Quaterniond orientation_;
  Vec3 velocity_ = Vec3::Zero();
  Vec3 origin_ = Vec3::Zero();  ///< world; of all places below
  Vec3 position_ = Vec3::Zero();
  Vec3 gyro_bias_ = Vec3::Zero();
  Vec3 accelerometer_bias_ = Vec3::Zero();
  Vec3 angular_velocity_ = Vec3::Zero();
  PerFoot<Vec3> feet_{Vec3::Zero(), Vec3::Zero()};
  PerFoot<bool> stands_{};
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace stagger::sim
