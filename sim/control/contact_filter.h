// The Kalman filter of a legged robot's base: an inertial unit, and feet that stay where they stand.
#pragma once

#include <Eigen/Geometry>

#include "engine/types.h"

namespace stagger::sim {

using engine::PerFoot;
using engine::Vec3;

/// Spectral densities [.../sqrt(Hz)] of continuous white noises, and standard deviations of what is
/// not known at the start.
struct ContactFilterNoise {
  double gyro = 0.0;                ///< [rad/s/sqrt(Hz)]
  double accelerometer = 0.0;       ///< [m/s^2/sqrt(Hz)]
  double gyro_walk = 0.0;           ///< of the bias [rad/s^2/sqrt(Hz)]
  double accelerometer_walk = 0.0;  ///< of the bias [m/s^3/sqrt(Hz)]
  double leg = 0.0;                 ///< of one look at a foot, each axis; a deviation [m]
  double start_tilt = 0.0;          ///< [rad]
  double start_velocity = 0.0;      ///< [m/s]
  double gyro_bias = 0.0;           ///< [rad/s]
  double accelerometer_bias = 0.0;  ///< [m/s^2]
};

/// Error-state filter over the base's orientation, velocity, position, both biases and the place of
/// each foot that stands (Bloesch et al., State Estimation for Legged Robots, RSS 2012, without the
/// feet's orientation), here with all errors in world axes. World yaw and place are not observable
/// and drift; the base and the feet drift together. Covariances are worked on by their structure:
/// three rows of blocks in the prediction, one scalar after the other in the update. No heap.
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
  /// The foot that stands is seen there, in the base's frame [m].
  void see(std::size_t foot, const Vec3& in_base);

  const Eigen::Quaterniond& orientation() const { return orientation_; }
  const Vec3& position() const { return position_; }
  const Vec3& velocity() const { return velocity_; }
  /// Mean over the last tick, world axes [rad/s].
  const Vec3& angular_velocity() const { return angular_velocity_; }
  const Vec3& gyro_bias() const { return gyro_bias_; }
  const Vec3& accelerometer_bias() const { return accelerometer_bias_; }
  const Vec3& foot(std::size_t foot) const { return feet_[foot]; }

  static constexpr int states = 21;
  using Covariance = Eigen::Matrix<double, states, states>;
  /// Of the errors [orientation, velocity, position, gyro bias, accelerometer bias, left foot, right
  /// foot], world axes but for the biases; a foot in the air has zeros.
  const Covariance& covariance() const { return covariance_; }

 private:
  using State = Eigen::Matrix<double, states, 1>;
  void take(const State& correction);

  ContactFilterNoise noise_;
  double dt_;
  double gravity_;
  Eigen::Quaterniond orientation_;
  Vec3 velocity_ = Vec3::Zero();
  Vec3 position_;
  Vec3 gyro_bias_ = Vec3::Zero();
  Vec3 accelerometer_bias_ = Vec3::Zero();
  Vec3 angular_velocity_ = Vec3::Zero();
  PerFoot<Vec3> feet_{Vec3::Zero(), Vec3::Zero()};
  PerFoot<bool> stands_{};
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace stagger::sim
