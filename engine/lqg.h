// The low-level controller: Kalman filter, integrator and state feedback on the LIPM, eqs. (5)-(8).
#pragma once

#include "engine/convex_polygon.h"
#include "engine/dcm_goal.h"
#include "engine/lipm.h"
#include "engine/parameters.h"

namespace stagger::engine {

/// What the controller is to track this tick.
struct LqgReference {
  Vec2 com = Vec2::Zero();
  Vec2 dcm = Vec2::Zero();
  Vec2 zmp = Vec2::Zero();  ///< fed forward: without it eq. (8) as printed lags by metres
};

/// What the hips do for the balance this tick, world axes.
struct HipAid {
  Vec2 shift = Vec2::Zero();  ///< of the effective ZMP [m]
  Vec2 swing = Vec2::Zero();  ///< direction in which they swing: the ZMP has to back them up there
};

/// Both axes at once; they share the gains. The estimator is fed with the clamped ZMP, so that it
/// knows what the foot really did, and the integrator stops while the ZMP is clamped. A push is not
/// in its model: when the innovations, averaged over some ticks, say that there was one, it trusts
/// the measurements again as if it had just begun, and settles anew.
class Lqg {
 public:
  /// Throws std::invalid_argument when the weights have no stabilising gain.
  explicit Lqg(const Parameters& parameters);

  /// Takes the measured CoM and DCM into the estimate, which starts at the first of them, and again
  /// when it has got lost. Call once a tick, before control(); not at all in a tick without a
  /// measurement, whose estimate is then the prediction.
  void estimate(const Vec2& com, const Vec2& dcm);

  /// ZMP command inside the polygon, and the prediction for the next tick. `shift` of the effective
  /// ZMP comes from the hips: the ankle need not do that part. `act` off leaves the ZMP at its
  /// reference (the ankle strategy is switched off). A `goal` comes before the tracking.
  Vec2 control(const LqgReference& reference, const ConvexPolygon& polygon, const HipAid& hip,
               bool act, bool integrate, const DcmGoal& goal = {});

  /// Takes over the weights and noises of another one for the same pendulum. The estimate stays,
  /// and so does what the integral adds to the ZMP.
  void retune(const Lqg& other);

  Vec2 com() const { return state_.row(0); }
  Vec2 dcm() const { return state_.row(1); }
  /// Standard deviation of dcm() after the last measurement, on each axis [m].
  double dcm_deviation() const { return deviation_; }
  const Eigen::RowVector3d& feedback_gain() const { return feedback_; }
  /// Of the settled filter.
  const Eigen::Matrix2d& estimator_gain() const { return settled_gain_; }

 private:
  double tick_;
  DiscreteLipm lipm_;
  Eigen::RowVector3d feedback_;  ///< of [CoM error, DCM error, integral of CoM error]
  double process_;
  double measurement_;
  double gate_;
  Eigen::Matrix2d settled_gain_;
  Eigen::Matrix2d covariance_;  ///< of the prediction, the same on both axes
  double deviation_ = 0.0;
  Eigen::Matrix2d innovation_ = Eigen::Matrix2d::Zero();  ///< averaged; rows CoM, DCM
  Eigen::Matrix2d state_ = Eigen::Matrix2d::Zero();       ///< rows CoM, DCM; columns x, y
  Vec2 integral_ = Vec2::Zero();
  bool started_ = false;
};

}  // namespace stagger::engine
