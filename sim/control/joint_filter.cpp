#include "sim/control/joint_filter.h"

#include <Eigen/LU>
#include <algorithm>

#include "engine/riccati.h"

namespace stagger::sim {
namespace {

// Less than any encoder has: the design must not be asked for a gain without noise.
constexpr double least_position_noise = 1e-7;  // [rad]
constexpr double least_velocity_noise = 1e-5;  // [rad/s]

}  // namespace

JointFilter::JointFilter(const EncoderParameters& encoder, double acceleration, double dt,
                         const Eigen::VectorXd& q)
    : dt_(dt), q_(q), qd_(Eigen::VectorXd::Zero(q.size())) {
  Eigen::Matrix2d a;
  a << 1.0, dt, 0.0, 1.0;
  const Eigen::Vector2d effect(0.5 * dt * dt, dt);
  const Eigen::Matrix2d process = acceleration * acceleration * effect * effect.transpose();
  const Eigen::Vector2d noise(std::max(encoder.position_noise, least_position_noise),
                              std::max(encoder.velocity_noise, least_velocity_noise));
  const Eigen::Matrix2d measurement = noise.cwiseAbs2().asDiagonal();
  const Eigen::Matrix2d covariance =
      engine::solve_dare(a.transpose(), Eigen::Matrix2d::Identity(), process, measurement);
  gain_ = covariance * (covariance + measurement).inverse();
}

void JointFilter::update(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
  for (Eigen::Index i = 0; i < q_.size(); ++i) {
    const double predicted = q_[i] + dt_ * qd_[i];
    const double position_error = q[i] - predicted;
    const double velocity_error = qd[i] - qd_[i];
    q_[i] = predicted + gain_(0, 0) * position_error + gain_(0, 1) * velocity_error;
    qd_[i] += gain_(1, 0) * position_error + gain_(1, 1) * velocity_error;
  }
}

}  // namespace stagger::sim
