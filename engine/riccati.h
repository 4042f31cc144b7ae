// Discrete algebraic Riccati equation, and the gains that follow from it. For set-up, not for the
// tick.
#pragma once

#include <Eigen/Core>

namespace stagger::engine {

/// Stabilising solution X (n x n) of X = A' X A - A' X B (R + B' X B)^-1 B' X A + Q with A (n x n),
/// B (n x m), Q (n x n), R (m x m), by the structured doubling algorithm (Chu, Fan, Lin 2005):
/// quadratic convergence, also for unstable A. Throws std::invalid_argument when there is none (not
/// stabilisable, or R not positive definite).
Eigen::MatrixXd solve_dare(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                           const Eigen::MatrixXd& q, const Eigen::MatrixXd& r);

/// LQR gain K (m x n) of u = -K x for the weights Q and R. Throws as solve_dare does.
Eigen::MatrixXd lqr_gain(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                         const Eigen::MatrixXd& q, const Eigen::MatrixXd& r);

}  // namespace stagger::engine
