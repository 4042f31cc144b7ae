// Closed forms of the linear inverted pendulum, eqs. (2) to (4) and their discretisation, eq. (5).
#pragma once

#include "engine/types.h"

namespace stagger::engine {

/// A piece of time during which the ZMP moves on a straight line at constant speed.
struct ZmpSegment {
  double duration = 0.0;  ///< [s], may be 0
  Vec2 start = Vec2::Zero();
  Vec2 end = Vec2::Zero();

  Vec2 velocity() const;       ///< m [m/s]; zero for a segment of no duration
  Vec2 zmp(double tau) const;  ///< p(tau), tau in [0, duration]
};

/// DCM at `tau` of a segment that is to end at `dcm_end`: zeta = p + m/w + (zeta_b - p_b - m/w)
/// e^{-w (D - tau)}. Written from the end, because forwards the DCM magnifies every rounding error.
Vec2 dcm_before(const ZmpSegment& segment, const Vec2& dcm_end, double tau, double omega);

/// CoM at `tau` of a segment that starts from `com_start` and `dcm_start`: the exact solution of
/// eq. (2) for a moving ZMP, c = p + (A/2) e^{w tau} + (c_a - p_a - A/2) e^{-w tau}.
Vec2 com_after(const ZmpSegment& segment, const Vec2& com_start, const Vec2& dcm_start, double tau,
               double omega);

/// DCM after time `t` with the ZMP held still: zeta(t) = p + (zeta_0 - p) e^{w t}.
inline Vec2 dcm_after(const Vec2& dcm, const Vec2& zmp, double t, double omega) {
  return zmp + (dcm - zmp) * std::exp(omega * t);
}

/// gamma = (1 - e^{-w T}) / (w T): how much of a step the DCM has to lead by at touchdown when the
/// ZMP then moves to the new foot in time T; 1 for T = 0.
double transfer_factor(double t_ds, double omega);

/// x' = A x + B p over one control period, x = [CoM, DCM] on one axis, ZMP held: eq. (5), exact.
struct DiscreteLipm {
  Eigen::Matrix2d a;
  Eigen::Vector2d b;
};
DiscreteLipm discretise(double omega, double dt);

}  // namespace stagger::engine
