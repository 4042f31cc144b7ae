#include "engine/lqg.h"

#include <Eigen/LU>
#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "engine/riccati.h"

namespace stagger::engine {
namespace {

Eigen::RowVector3d stabilising_feedback(const Parameters& p, const DiscreteLipm& lipm) {
  const Eigen::Matrix<double, 1, 1> r(p.lqr_zmp_weight * p.tick);
  const Eigen::Matrix3d q = (p.lqr_state_weight * p.tick).asDiagonal();
  if (p.lqr_state_weight(2) == 0.0) {
    // An integrator that costs nothing would stay at z = 1, and the design would have no solution.
    Eigen::RowVector3d gain = Eigen::RowVector3d::Zero();
    gain.head<2>() = lqr_gain(lipm.a, lipm.b, q.topLeftCorner<2, 2>(), r);
    return gain;
  }
  // [CoM error, DCM error, integral of CoM error]; one integral only: both are not stabilisable.
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  a.topLeftCorner<2, 2>() = lipm.a;
  a(2, 0) = p.tick;
  a(2, 2) = 1.0;
  Eigen::Vector3d b;
  b << lipm.b, 0.0;
  return lqr_gain(a, b, q, r);
}

Eigen::RowVector3d design_feedback(const Parameters& p, const DiscreteLipm& lipm) {
  try {
    return stabilising_feedback(p, lipm);
  } catch (const std::invalid_argument& error) {
    const Vec3& q = p.lqr_state_weight;
    std::ostringstream text;
    text << "engine parameters lqr_state_weight = (" << q[0] << ", " << q[1] << ", " << q[2]
         << "), lqr_zmp_weight = " << p.lqr_zmp_weight
         << " give no controller that keeps the balance; one of them has to be greater than 0, and "
            "the "
            "third, of the integral, either 0 (no integrator) or not small beyond reason: "
         << error.what();
    throw std::invalid_argument(text.str());
  }
}

/// Weight of the newest innovation in their average: about nine ticks count.
constexpr double innovation_smoothing = 0.2;
/// A ZMP that lacks this much to meet a goal gives up tracking altogether [m].
constexpr double goal_blend = 0.01;
/// What a push may have done to the DCM: variance of 10 cm [m^2].
constexpr double push_variance = 0.01;

}  // namespace

Lqg::Lqg(const Parameters& p)
    : tick_(p.tick),
      lipm_(discretise(natural_frequency(p), p.tick)),
      feedback_(design_feedback(p, lipm_)),
      process_(p.process_noise),
      measurement_(p.measurement_noise),
      gate_(p.push_gate) {
  const Eigen::Matrix2d unit = Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d process = process_ * unit;
  const Eigen::Matrix2d measurement = measurement_ * unit;
  covariance_ = solve_dare(lipm_.a.transpose(), unit, process, measurement);
  settled_gain_ = covariance_ * (covariance_ + measurement).inverse();
}

void Lqg::retune(const Lqg& other) {
  integral_ = other.feedback_(2) != 0.0 ? (feedback_(2) / other.feedback_(2) * integral_).eval()
                                        : Vec2(Vec2::Zero());
  feedback_ = other.feedback_;
  process_ = other.process_;
  measurement_ = other.measurement_;
  gate_ = other.gate_;
  settled_gain_ = other.settled_gain_;
}

void Lqg::estimate(const Vec2& com, const Vec2& dcm) {
  Eigen::Matrix2d measured;
  measured.row(0) = com;
  measured.row(1) = dcm;
  constexpr double lost = 1e6;  // a prediction without measurements runs away [m]
  if (!started_ || !(state_.cwiseAbs().maxCoeff() < lost)) {
    state_ = measured;
    // No better known than one measurement tells: the next ones count as much.
    covariance_ = measurement_ * lipm_.a * lipm_.a.transpose();
    covariance_.diagonal().array() += process_;
    integral_.setZero();
    innovation_.setZero();
    deviation_ = std::sqrt(measurement_);
    started_ = true;
    return;
  }
  const Eigen::Matrix2d unit = Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d spread = covariance_ + measurement_ * unit;
  Eigen::Matrix2d innovation = measured - state_;
  innovation_ += innovation_smoothing * (innovation - innovation_);
  // An average of independent innovations has this part of their variance.
  constexpr double share = innovation_smoothing / (2.0 - innovation_smoothing);
  const double limit = gate_ * gate_ * share * spread(1, 1);
  if (innovation_.row(1).squaredNorm() > limit) {
    covariance_(1, 1) += push_variance;
    innovation_.setZero();
  }
  const Eigen::Matrix2d gain = covariance_ * (covariance_ + measurement_ * unit).inverse();
  state_ += (gain * innovation).eval();
  deviation_ = std::sqrt(gain(1, 1) * measurement_);
  covariance_ = (lipm_.a * (covariance_ - gain * covariance_) * lipm_.a.transpose()).eval();
  covariance_.diagonal().array() += process_;
}

Vec2 Lqg::control(const LqgReference& reference, const ConvexPolygon& polygon, const HipAid& hip,
                  bool act, bool integrate, const DcmGoal& goal) {
  const Vec2 com_error = com() - reference.com;
  const Vec2 dcm_error = dcm() - reference.dcm;
  Vec2 wanted = reference.zmp;
  if (act) {
    wanted -= feedback_(0) * com_error + feedback_(1) * dcm_error + feedback_(2) * integral_;
    wanted += hip.swing - hip.shift;  // a metre in the direction of the swing: the edge of the foot
  }
  Vec2 zmp = polygon.clamp(wanted);
  if (act && goal.region != nullptr) {
    // What the command comes to when the plan's ZMP moves on under it: about the mean of where it
    // is now and where it will be at the end, if no edge stops it.
    const Vec2 end = polygon.clamp(zmp + 2.0 * (goal.held - reference.zmp));
    const Vec2 held = 0.5 * (zmp + end);
    const Vec2 better = zmp_towards(goal, held, dcm(), polygon);
    // Where that is not enough all that can be done is done at once; gradually, lest it chatter
    // where the goal is only just missed.
    const double urgency = std::min((better - held).norm() / goal_blend, 1.0);
    zmp += urgency * (better - zmp);
  }
  const bool clamped = (zmp - wanted).squaredNorm() > 0.0;
  if (act && integrate && !clamped) integral_ += tick_ * com_error;
  state_ = (lipm_.a * state_ + lipm_.b * (zmp + hip.shift).transpose()).eval();
  return zmp;
}

}  // namespace stagger::engine
