// Joint angles and velocities from encoders: a Kalman filter of fixed gain for each joint.
#pragma once

#include <Eigen/Core>

#include "sim/control/sensors.h"

namespace stagger::sim {

/// Between two ticks a joint's acceleration is taken for white noise: its deviation decides how far
/// the filter trusts the encoders, and so how far its velocity lags behind. No heap after
/// construction.
class JointFilter {
 public:
  /// `acceleration` [rad/s^2] is the deviation of a joint's acceleration.
  JointFilter(const EncoderParameters& encoder, double acceleration, double dt,
              const Eigen::VectorXd& q);

  void update(const Eigen::VectorXd& q, const Eigen::VectorXd& qd);
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& qd() const { return qd_; }
  /// Of [q, qd] by the errors of both.
  const Eigen::Matrix2d& gain() const { return gain_; }

 private:
  double dt_;
  Eigen::Matrix2d gain_;
  Eigen::VectorXd q_;
  Eigen::VectorXd qd_;
};

}  // namespace stagger::sim
