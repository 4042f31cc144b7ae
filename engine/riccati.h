// Discrete algebraic Riccati equation of small, fixed size.
#pragma once

#include <Eigen/Dense>
#include <stdexcept>

namespace stagger::engine {

/// Stabilising solution X of X = A' X A - A' X B (R + B' X B)^-1 B' X A + Q, by the structured
/// doubling algorithm (Chu, Fan, Lin 2005): quadratic convergence, also for unstable A.
/// Throws std::invalid_argument when there is none (not stabilisable, or R not positive definite).
template <int N, int M>
Eigen::Matrix<double, N, N> solve_dare(const Eigen::Matrix<double, N, N>& a,
                                       const Eigen::Matrix<double, N, M>& b,
                                       const Eigen::Matrix<double, N, N>& q,
                                       const Eigen::Matrix<double, M, M>& r) {
  using Square = Eigen::Matrix<double, N, N>;
  const Eigen::LLT<Eigen::Matrix<double, M, M>> r_llt(r);
  if (r_llt.info() != Eigen::Success) {
    throw std::invalid_argument("Riccati: the input weight is not positive definite");
  }
  Square ak = a;
  Square g = b * r_llt.solve(b.transpose());
  Square x = q;
  constexpr int most_doublings = 60;
  for (int i = 0; i < most_doublings; ++i) {
    const Eigen::PartialPivLU<Square> w(Square::Identity() + g * x);
    const Square w_a = w.solve(ak);
    const Square w_g = w.solve(g);
    const Square step = ak.transpose() * x * w_a;
    g += ak * w_g * ak.transpose();
    x += step;
    ak = (ak * w_a).eval();
    if (step.norm() <= 1e-15 * x.norm()) break;
  }
  x = (0.5 * (x + x.transpose())).eval();

  // A solution only counts when its closed loop is stable: the doubling also stops at others.
  const Eigen::Matrix<double, M, N> k = (r + b.transpose() * x * b).ldlt().solve(b.transpose() * x * a);
  const Square closed = a - b * k;
  const double radius = closed.eigenvalues().cwiseAbs().maxCoeff();
  if (!x.allFinite() || !(radius < 1.0 - 1e-9)) {
    throw std::invalid_argument("Riccati: no stabilising solution (is every unstable mode reachable and weighted?)");
  }
  return x;
}

/// LQR gain K of u = -K x for the weights.
template <int N, int M>
Eigen::Matrix<double, M, N> lqr_gain(const Eigen::Matrix<double, N, N>& a,
                                     const Eigen::Matrix<double, N, M>& b,
                                     const Eigen::Matrix<double, N, N>& q,
                                     const Eigen::Matrix<double, M, M>& r) {
  const Eigen::Matrix<double, N, N> x = solve_dare<N, M>(a, b, q, r);
  return (r + b.transpose() * x * b).ldlt().solve(b.transpose() * x * a);
}

/// Steady gain L of the current-estimator Kalman filter, x_hat += L (y - x_hat), full state measured.
template <int N>
Eigen::Matrix<double, N, N> kalman_gain(const Eigen::Matrix<double, N, N>& a,
                                        const Eigen::Matrix<double, N, N>& process,
                                        const Eigen::Matrix<double, N, N>& measurement) {
  using Square = Eigen::Matrix<double, N, N>;
  const Square p = solve_dare<N, N>(a.transpose(), Square::Identity(), process, measurement);
  return p * (p + measurement).inverse();
}

}  // namespace stagger::engine
