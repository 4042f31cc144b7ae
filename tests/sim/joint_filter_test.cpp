#include "sim/control/joint_filter.h"

#include <gtest/gtest.h>

#include "tests/sim/tick.h"

namespace stagger::sim {
namespace {

constexpr double acceleration = 40.0;

Eigen::VectorXd one(double x) { return Eigen::VectorXd::Constant(1, x); }

TEST(JointFilter, TakesNoiseOutOfTheVelocity) {
  const EncoderParameters encoder;
  JointFilter filter(encoder, acceleration, dt, one(0.3));
  Noise noise(1);
  double squares = 0.0;
  constexpr int n = 5000;
  for (int i = 0; i < n; ++i) {
    filter.update(one(0.3 + encoder.position_noise * noise()),
                  one(encoder.velocity_noise * noise()));
    if (i >= 100) squares += filter.qd()[0] * filter.qd()[0];
  }
  EXPECT_LT(std::sqrt(squares / (n - 100)), 0.95 * encoder.velocity_noise);
}

TEST(JointFilter, HardlyLags) {
  // A joint that speeds up steadily: its velocity is less than a tick late.
  JointFilter filter({}, acceleration, dt, one(0.0));
  constexpr double speeding_up = 500.0;  // [rad/s^2]
  double t = 0.0;
  for (int i = 1; i <= 100; ++i) {
    t = i * dt;
    filter.update(one(0.5 * speeding_up * t * t), one(speeding_up * t));
  }
  EXPECT_LT(speeding_up * t - filter.qd()[0], speeding_up * dt);
  EXPECT_NEAR(filter.q()[0], 0.5 * speeding_up * t * t, 1e-3);
}

TEST(JointFilter, TakesPerfectEncodersAtTheirWord) {
  JointFilter filter({0.0, 0.0}, acceleration, dt, one(0.0));
  for (int i = 1; i <= 200; ++i) {
    const double q = 0.2 * (1.0 - std::cos(20.0 * i * dt));
    const double qd = 4.0 * std::sin(20.0 * i * dt);
    filter.update(one(q), one(qd));
    EXPECT_NEAR(filter.q()[0], q, 1e-5);
    EXPECT_NEAR(filter.qd()[0], qd, 1e-2);
  }
}

}  // namespace
}  // namespace stagger::sim
