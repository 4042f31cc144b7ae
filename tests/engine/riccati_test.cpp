#include "engine/riccati.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <stdexcept>

namespace stagger::engine {
namespace {

using Matrix1 = Eigen::Matrix<double, 1, 1>;

TEST(Riccati, SolvesTheEquation) {
  Eigen::Matrix3d a;
  a << 1.1, 0.2, 0.0, -0.1, 0.9, 0.3, 0.02, 0.0, 1.05;
  const Eigen::Vector3d b(0.1, 0.5, 1.0);
  const Eigen::Matrix3d q = Eigen::Vector3d(1.0, 2.0, 0.5).asDiagonal();
  const Matrix1 r(0.3);
  const Eigen::Matrix3d x = solve_dare(a, b, q, r);
  const Matrix1 s = r + b.transpose() * x * b;
  const Eigen::Matrix3d residual =
      a.transpose() * x * a - x + q - a.transpose() * x * b * s.inverse() * b.transpose() * x * a;
  EXPECT_LT(residual.norm(), 1e-10 * x.norm());
}

TEST(Riccati, ScalarCaseHasAClosedForm) {
  // x = a^2 x r / (r + x) + q for b = 1.
  const double a = 1.5;
  const double q = 0.7;
  const double r = 2.0;
  const double p = r - a * a * r - q;
  const double expected = (-p + std::sqrt(p * p + 4.0 * q * r)) / 2.0;
  EXPECT_NEAR((solve_dare(Matrix1(a), Matrix1(1.0), Matrix1(q), Matrix1(r))(0)), expected, 1e-12);
}

TEST(Riccati, RefusesWhatCannotBeStabilised) {
  // The second mode is unstable and the input does not reach it.
  const Eigen::Matrix2d a = Eigen::Vector2d(0.9, 1.1).asDiagonal();
  const Eigen::Vector2d b(1.0, 0.0);
  EXPECT_THROW((solve_dare(a, b, Eigen::Matrix2d::Identity(), Matrix1(1.0))),
               std::invalid_argument);
}

TEST(Riccati, RefusesAnInputWeightThatIsNotPositive) {
  EXPECT_THROW((solve_dare(Matrix1(1.1), Matrix1(1.0), Matrix1(1.0), Matrix1(0.0))),
               std::invalid_argument);
}

}  // namespace
}  // namespace stagger::engine
