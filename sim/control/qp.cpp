#include "sim/control/qp.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stagger::sim {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

void QpSolver::directions(const Eigen::Ref<const Eigen::VectorXd>& normal) {
  const Eigen::Index q = active_count_;
  d_.noalias() = j_.transpose() * normal;
  primal_.noalias() = j_.rightCols(n_ - q) * d_.tail(n_ - q);
  if (q > 0) {
    dual_.head(q) = d_.head(q);
    r_.topLeftCorner(q, q).triangularView<Eigen::Upper>().solveInPlace(dual_.head(q));
  }
}

bool QpSolver::add_constraint() {
  // Rotate the tail of d onto its first entry; the same rotations keep J's columns consistent.
  const Eigen::Index q = active_count_;
  for (Eigen::Index i = n_ - 1; i > q; --i) {
    const double a = d_[i - 1];
    const double b = d_[i];
    if (b == 0.0) continue;
    const double length = std::hypot(a, b);
    const double c = a / length;
    const double s = b / length;
    d_[i - 1] = length;
    d_[i] = 0.0;
    for (Eigen::Index k = 0; k < n_; ++k) {
      const double left = j_(k, i - 1);
      const double right = j_(k, i);
      j_(k, i - 1) = c * left + s * right;
      j_(k, i) = c * right - s * left;
    }
  }
  r_.col(q).head(q + 1) = d_.head(q + 1);
  ++active_count_;
  // A normal that depends on the active ones would make R singular.
  return std::abs(d_[q]) > 1e-12;
}

void QpSolver::drop(Eigen::Index position) {
  const Eigen::Index q = active_count_;
  if (active_[static_cast<std::size_t>(position)] >= 0) {
    is_active_[static_cast<std::size_t>(active_[static_cast<std::size_t>(position)])] = 0;
  }
  for (Eigen::Index i = position; i + 1 < q; ++i) {
    active_[static_cast<std::size_t>(i)] = active_[static_cast<std::size_t>(i + 1)];
    u_[i] = u_[i + 1];
    r_.col(i).head(q) = r_.col(i + 1).head(q);
  }
  u_[q - 1] = u_[q];  // the multiplier of the constraint that is being taken in
  u_[q] = 0.0;
  --active_count_;
  active_.pop_back();
  // R is upper Hessenberg from `position` on: rotate it back to upper triangular.
  for (Eigen::Index i = position; i < active_count_; ++i) {
    const double a = r_(i, i);
    const double b = r_(i + 1, i);
    if (b == 0.0) continue;
    const double length = std::hypot(a, b);
    const double c = a / length;
    const double s = b / length;
    for (Eigen::Index k = i; k < active_count_; ++k) {
      const double upper = r_(i, k);
      const double lower = r_(i + 1, k);
      r_(i, k) = c * upper + s * lower;
      r_(i + 1, k) = c * lower - s * upper;
    }
    for (Eigen::Index k = 0; k < n_; ++k) {
      const double left = j_(k, i);
      const double right = j_(k, i + 1);
      j_(k, i) = c * left + s * right;
      j_(k, i + 1) = c * right - s * left;
    }
  }
}

QpStatus QpSolver::solve(const QpProblem& problem) {
  n_ = problem.h.rows();
  const Eigen::Index equalities = problem.equality.rows();
  inequalities_ = problem.inequality.rows();
  iterations_ = 0;
  active_count_ = 0;
  active_.clear();
  is_active_.assign(static_cast<std::size_t>(inequalities_), 0);

  llt_.compute(problem.h);
  if (llt_.info() != Eigen::Success) return QpStatus::not_convex;
  j_.setIdentity(n_, n_);
  llt_.matrixU().solveInPlace(j_);
  r_.setZero(n_, n_);
  u_.setZero(equalities + inequalities_ + 1);
  d_.resize(n_);
  primal_.resize(n_);
  dual_.resize(std::max<Eigen::Index>(n_, equalities + inequalities_));
  slack_.resize(inequalities_);
  x_ = llt_.solve(-problem.g);

  for (Eigen::Index i = 0; i < equalities; ++i) {
    const auto normal = problem.equality.row(i).transpose();
    directions(normal);
    const double curvature = primal_.dot(normal);
    if (!(curvature > 1e-14)) return QpStatus::infeasible;
    const double t = (problem.equality_value[i] - normal.dot(x_)) / curvature;
    x_ += t * primal_;
    u_.head(active_count_) -= t * dual_.head(active_count_);
    u_[active_count_] = t;
    active_.push_back(-1 - i);
    if (!add_constraint()) return QpStatus::infeasible;
  }

  const int most = 20 * static_cast<int>(n_ + inequalities_);
  while (iterations_++ < most) {
    // The most violated constraint, relative to its size.
    slack_.noalias() = problem.inequality * x_;
    slack_ -= problem.inequality_bound;
    Eigen::Index worst = -1;
    double least = 0.0;
    for (Eigen::Index i = 0; i < inequalities_; ++i) {
      const double tolerance = 1e-9 * (1.0 + std::abs(problem.inequality_bound[i]));
      if (is_active_[static_cast<std::size_t>(i)] == 0 && slack_[i] < -tolerance &&
          slack_[i] < least) {
        least = slack_[i];
        worst = i;
      }
    }
    if (worst < 0) return QpStatus::solved;

    const auto normal = problem.inequality.row(worst).transpose();
    double violation = slack_[worst];
    u_[active_count_] = 0.0;
    while (true) {
      directions(normal);
      const Eigen::Index q = active_count_;
      // How far until an active inequality lets go, and until the new one holds.
      double dual_limit = infinity;
      Eigen::Index leaver = -1;
      for (Eigen::Index k = equalities; k < q; ++k) {
        if (dual_[k] > 0.0 && u_[k] / dual_[k] < dual_limit) {
          dual_limit = u_[k] / dual_[k];
          leaver = k;
        }
      }
      const double curvature = primal_.dot(normal);
      const double full = curvature > 1e-14 ? -violation / curvature : infinity;
      const double t = std::min(dual_limit, full);
      if (t == infinity) return QpStatus::infeasible;
      u_.head(q) -= t * dual_.head(q);
      u_[q] += t;
      if (full != infinity) {
        x_ += t * primal_;
        violation += t * curvature;
      }
      if (t == full) {
        active_.push_back(worst);
        is_active_[static_cast<std::size_t>(worst)] = 1;
        if (!add_constraint()) return QpStatus::out_of_steps;
        break;
      }
      drop(leaver);
      if (++iterations_ > most) return QpStatus::out_of_steps;
    }
  }
  return QpStatus::out_of_steps;
}

Eigen::VectorXd QpSolver::inequality_multipliers() const {
  Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(inequalities_);
  for (Eigen::Index k = 0; k < active_count_; ++k) {
    const Eigen::Index constraint = active_[static_cast<std::size_t>(k)];
    if (constraint >= 0) multipliers[constraint] = u_[k];
  }
  return multipliers;
}

}  // namespace stagger::sim
