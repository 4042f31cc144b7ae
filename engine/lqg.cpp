#include "engine/lqg.h"

#include "engine/riccati.h"

namespace stagger::engine {
namespace {

Eigen::RowVector3d design_feedback(const Parameters& p, const DiscreteLipm& lipm) {
  // [CoM error, DCM error, integral of CoM error]; one integral only: both are not stabilisable.
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  a.topLeftCorner<2, 2>() = lipm.a;
  a(2, 0) = p.tick;
  a(2, 2) = 1.0;
  Eigen::Vector3d b;
  b << lipm.b, 0.0;
  const Eigen::Matrix3d q = (p.lqr_state_weight * p.tick).asDiagonal();
  const Eigen::Matrix<double, 1, 1> r(p.lqr_zmp_weight * p.tick);
  return lqr_gain<3, 1>(a, b, q, r);
}

}  // namespace

Lqg::Lqg(const Parameters& parameters)
    : tick_(parameters.tick),
      lipm_(discretise(natural_frequency(parameters), parameters.tick)),
      feedback_(design_feedback(parameters, lipm_)),
      estimator_(kalman_gain<2>(lipm_.a, parameters.process_noise * Eigen::Matrix2d::Identity(),
                                parameters.measurement_noise * Eigen::Matrix2d::Identity())) {}

void Lqg::estimate(const Vec2& com, const Vec2& dcm) {
  Eigen::Matrix2d measured;
  measured.row(0) = com;
  measured.row(1) = dcm;
  if (!started_) {
    state_ = measured;
    integral_.setZero();
    started_ = true;
    return;
  }
  state_ += (estimator_ * (measured - state_)).eval();
}

Vec2 Lqg::control(const LqgReference& reference, const SupportPolygon& polygon, bool act,
                  bool integrate) {
  const Vec2 com_error = com() - reference.com;
  const Vec2 dcm_error = dcm() - reference.dcm;
  Vec2 wanted = reference.zmp;
  if (act) {
    wanted -= feedback_(0) * com_error + feedback_(1) * dcm_error + feedback_(2) * integral_;
  }
  const Vec2 zmp = polygon.clamp(wanted);
  const bool clamped = (zmp - wanted).squaredNorm() > 0.0;
  if (act && integrate && !clamped) integral_ += tick_ * com_error;
  state_ = (lipm_.a * state_ + lipm_.b * zmp.transpose()).eval();
  return zmp;
}

}  // namespace stagger::engine
