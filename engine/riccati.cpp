#include "engine/riccati.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <stdexcept>

namespace stagger::engine {
namespace {

Eigen::MatrixXd gain_of(const Eigen::MatrixXd& x, const Eigen::MatrixXd& a,
                        const Eigen::MatrixXd& b, const Eigen::MatrixXd& r) {
  const Eigen::MatrixXd b_x = b.transpose() * x;
  return (r + b_x * b).ldlt().solve(b_x * a);
}

/// Do the powers of the matrix vanish? Squares it until they have, or have not.
bool is_stable(Eigen::MatrixXd power) {
  // 2^32 ticks: a mode that has not died away by then is not stable in any useful sense.
  constexpr int squarings = 32;
  for (int i = 0; i < squarings; ++i) {
    power = (power * power).eval();
    if (!power.allFinite()) return false;
  }
  return power.norm() < 1e-6;
}

}  // namespace

Eigen::MatrixXd solve_dare(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                           const Eigen::MatrixXd& q, const Eigen::MatrixXd& r) {
  const Eigen::LLT<Eigen::MatrixXd> r_llt(r);
  if (r_llt.info() != Eigen::Success) {
    throw std::invalid_argument("Riccati: the input weight is not positive definite");
  }
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(a.rows(), a.cols());
  Eigen::MatrixXd ak = a;
  Eigen::MatrixXd g = b * r_llt.solve(b.transpose());
  Eigen::MatrixXd x = q;
  constexpr int most_doublings = 60;
  for (int i = 0; i < most_doublings; ++i) {
    const Eigen::PartialPivLU<Eigen::MatrixXd> w(identity + g * x);
    const Eigen::MatrixXd w_a = w.solve(ak);
    const Eigen::MatrixXd w_g = w.solve(g);
    const Eigen::MatrixXd step = ak.transpose() * x * w_a;
    g += ak * w_g * ak.transpose();
    x += step;
    ak = (ak * w_a).eval();
    if (step.norm() <= 1e-15 * x.norm()) break;
  }
  x = (0.5 * (x + x.transpose())).eval();

  // A solution only counts when its closed loop is stable: the doubling also stops at others.
  if (!x.allFinite() || !is_stable(a - b * gain_of(x, a, b, r))) {
    throw std::invalid_argument(
        "Riccati: no stabilising solution (is every unstable mode reachable and weighted?)");
  }
  return x;
}

Eigen::MatrixXd lqr_gain(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                         const Eigen::MatrixXd& q, const Eigen::MatrixXd& r) {
  return gain_of(solve_dare(a, b, q, r), a, b, r);
}

}  // namespace stagger::engine
