#include "sim/control/qp.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stagger::sim {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Of R: normals that depend on each other more than this leave nothing to divide by.
constexpr double least_pivot = 1e-12;

constexpr Eigen::Index is_equality = -1;

}  // namespace

bool QpSolver::factorise(const QpProblem& problem) {
  const Eigen::Index dense = problem.h.rows();
  const Eigen::Index rest = problem.diagonal.size();
  n_ = dense + rest;
  llt_.compute(problem.h);
  if (llt_.info() != Eigen::Success) return false;
  if (rest > 0 && !(problem.diagonal.minCoeff() > 0.0)) return false;
  j_.setZero(n_, n_);
  auto block = j_.topLeftCorner(dense, dense);
  block.diagonal().setOnes();
  llt_.matrixU().solveInPlace(block);
  j_.diagonal().tail(rest) = problem.diagonal.cwiseSqrt().cwiseInverse();
  x_.resize(n_);
  x_.head(dense) = -problem.g.head(dense);
  llt_.solveInPlace(x_.head(dense));
  x_.tail(rest) = -problem.g.tail(rest).cwiseQuotient(problem.diagonal);
  return true;
}

void QpSolver::reflect(Eigen::Index first) {
  const Eigen::Index tail = n_ - first;
  auto d = d_.tail(tail);
  const double length = d.norm();
  if (length == 0.0) return;
  // Householder's reflection, with the sign that cancels nothing. It takes d to -sign * length.
  const double sign = d[0] < 0.0 ? -1.0 : 1.0;
  d[0] += sign * length;
  const double scale = 1.0 / (length * std::abs(d[0]));
  auto columns = j_.rightCols(tail);
  turned_.noalias() = columns * d;
  turned_ *= scale;
  columns.noalias() -= turned_ * d.transpose();
  d.setZero();
  d[0] = -sign * length;
}

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
  const Eigen::Index q = active_count_;
  reflect(q);
  r_.col(q).head(q + 1) = d_.head(q + 1);
  ++active_count_;
  // A normal that depends on the active ones would make R singular.
  return std::abs(d_[q]) > least_pivot;
}

bool QpSolver::add_equalities(const QpProblem& problem) {
  const Eigen::Index equalities = problem.equality.rows();
  for (Eigen::Index i = 0; i < equalities; ++i) {
    d_.noalias() = j_.transpose() * problem.equality.row(i).transpose();
    active_.push_back(is_equality);
    if (!add_constraint()) return false;
  }
  if (equalities == 0) return true;
  // The shortest way in the measure of H to where all hold.
  auto residual = dual_.head(equalities);
  residual = problem.equality_value;
  residual.noalias() -= problem.equality * x_;
  r_.topLeftCorner(equalities, equalities)
      .triangularView<Eigen::Upper>()
      .transpose()
      .solveInPlace(residual);
  x_.noalias() += j_.leftCols(equalities) * residual;
  return true;
}

void QpSolver::drop(Eigen::Index position) {
  const Eigen::Index q = active_count_;
  if (active_[static_cast<std::size_t>(position)] >= 0) {
    is_active_[static_cast<std::size_t>(active_[static_cast<std::size_t>(position)])] = 0;
  }
  for (Eigen::Index i = position; i + 1 < q; ++i) {
    active_[static_cast<std::size_t>(i)] = active_[static_cast<std::size_t>(i + 1)];
    u_[i] = u_[i + 1];
    r_.col(i).head(i + 2) = r_.col(i + 1).head(i + 2);
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
    Eigen::JacobiRotation<double> turn;
    turn.makeGivens(a, b);
    r_.middleCols(i, active_count_ - i).applyOnTheLeft(i, i + 1, turn.adjoint());
    j_.applyOnTheRight(i, i + 1, turn);
  }
}

QpStatus QpSolver::solve(const QpProblem& problem) {
  const Eigen::Index equalities = problem.equality.rows();
  inequalities_ = problem.inequality.rows();
  iterations_ = 0;
  active_count_ = 0;
  active_.clear();
  is_active_.assign(static_cast<std::size_t>(inequalities_), 0);

  if (!factorise(problem)) return QpStatus::not_convex;
  r_.resize(n_, n_);
  u_.setZero(equalities + inequalities_ + 1);
  d_.resize(n_);
  primal_.resize(n_);
  turned_.resize(n_);
  dual_.resize(std::max<Eigen::Index>(n_, equalities + inequalities_));
  slack_.resize(inequalities_);
  if (!add_equalities(problem)) return QpStatus::infeasible;

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
