#include "sim/control/qp.h"

#include <gtest/gtest.h>

#include <random>

namespace stagger::sim {
namespace {

QpProblem random_problem(std::mt19937& random, int n, int equalities, int inequalities) {
  std::normal_distribution<double> normal;
  const auto matrix = [&](int rows, int cols) {
    Eigen::MatrixXd m(rows, cols);
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < cols; ++j) m(i, j) = normal(random);
    }
    return m;
  };
  QpProblem p;
  const Eigen::MatrixXd root = matrix(n, n);
  p.h = root * root.transpose() + 1e-3 * Eigen::MatrixXd::Identity(n, n);
  p.g = matrix(n, 1);
  p.equality = matrix(equalities, n);
  p.inequality = matrix(inequalities, n);
  // A point that satisfies everything, so that the problem is feasible.
  const Eigen::VectorXd inside = matrix(n, 1);
  p.equality_value = p.equality * inside;
  p.inequality_bound = p.inequality * inside - matrix(inequalities, 1).cwiseAbs();
  return p;
}

// For a convex problem these conditions are not only necessary: the point is the optimum.
void expect_optimal(const QpProblem& p, const QpSolver& solver) {
  const Eigen::VectorXd& x = solver.solution();
  const Eigen::VectorXd u = solver.inequality_multipliers();
  const double scale = 1.0 + p.h.norm();
  EXPECT_LT((p.equality * x - p.equality_value).norm(), 1e-8);
  EXPECT_GT((p.inequality * x - p.inequality_bound).minCoeff(), -1e-8);
  EXPECT_GE(u.minCoeff(), 0.0);
  EXPECT_LT(u.cwiseProduct(p.inequality * x - p.inequality_bound).cwiseAbs().maxCoeff(),
            1e-7 * scale);
  // The gradient that is left lies in the span of the equality normals.
  Eigen::VectorXd gradient = p.h * x + p.g - p.inequality.transpose() * u;
  if (p.equality.rows() > 0) {
    const Eigen::MatrixXd normals = p.equality.transpose();
    gradient -= normals * normals.colPivHouseholderQr().solve(gradient).eval();
  }
  EXPECT_LT(gradient.norm(), 1e-7 * scale);
}

TEST(Qp, RandomProblemsMeetTheOptimalityConditions) {
  std::mt19937 random(7);
  QpSolver solver;
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 4 + trial % 30;
    const QpProblem p = random_problem(random, n, trial % 4, 2 * n);
    ASSERT_EQ(solver.solve(p), QpStatus::solved) << trial;
    expect_optimal(p, solver);
  }
}

TEST(Qp, UnconstrainedIsANewtonStep) {
  QpProblem p;
  p.h = Eigen::Vector2d(2.0, 4.0).asDiagonal();
  p.g = Eigen::Vector2d(-2.0, 4.0);
  p.equality.resize(0, 2);
  p.inequality.resize(0, 2);
  QpSolver solver;
  ASSERT_EQ(solver.solve(p), QpStatus::solved);
  EXPECT_LT((solver.solution() - Eigen::Vector2d(1.0, -1.0)).norm(), 1e-12);
}

TEST(Qp, SaysWhenConstraintsContradict) {
  QpProblem p;
  p.h = Eigen::Matrix2d::Identity();
  p.g = Eigen::Vector2d::Zero();
  p.equality.resize(0, 2);
  p.inequality.resize(2, 2);
  p.inequality << 1.0, 0.0, -1.0, 0.0;
  p.inequality_bound = Eigen::Vector2d(1.0, 1.0);  // x >= 1 and x <= -1
  QpSolver solver;
  EXPECT_EQ(solver.solve(p), QpStatus::infeasible);
}

TEST(Qp, SaysWhenTheCostHasNoBottom) {
  QpProblem p;
  p.h = Eigen::Vector2d(1.0, -1.0).asDiagonal();
  p.g = Eigen::Vector2d::Zero();
  p.equality.resize(0, 2);
  p.inequality.resize(0, 2);
  QpSolver solver;
  EXPECT_EQ(solver.solve(p), QpStatus::not_convex);
}

}  // namespace
}  // namespace stagger::sim
