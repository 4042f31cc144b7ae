#include "engine/hip_strategy.h"

#include <gtest/gtest.h>

#include "engine/lipm.h"
#include "tests/engine/omega.h"

namespace stagger::engine {
namespace {

constexpr double weight = 30.0 * 9.81;
constexpr double tick = 0.002;

HipParameters hip(double torque, double inertia, double angle) {
  HipParameters p;
  p.torque = torque;
  p.inertia = inertia;
  p.angle = angle;
  return p;
}

/// tau / (m g) (1 - e^{-w T1})^2, T1 = sqrt(J theta_max / tau): what a wheel can save at most.
double bound(const HipParameters& p) {
  const double t1 = std::sqrt(p.inertia * p.angle / p.torque);
  return p.torque / weight * std::pow(1.0 - std::exp(-omega * t1), 2);
}

struct Outcome {
  bool saved = false;
  double greatest_angle = 0.0;
  double greatest_torque = 0.0;
  double last_angle = 0.0;
};

/// A DCM that starts `beyond` the edge of a foot, the ZMP held at that edge as long as it is
/// needed.
Outcome run(const HipParameters& parameters, double beyond) {
  HipStrategy strategy(parameters, weight, omega, tick);
  double dcm = beyond;  // the edge is at 0, the foot at negative places
  Outcome outcome;
  for (int i = 0; i < 3000 && std::abs(dcm) < 1.0; ++i) {
    const std::array<Excess, 2> excess{Excess{dcm, -0.15 - dcm}, Excess{-1.0, -1.0}};
    // The ankle: the ZMP follows the DCM's way back into the foot.
    const bool swings = strategy.swing().x() > 0.0;
    const double zmp = swings ? 0.0 : std::clamp(dcm + 3.3 * (dcm + 0.075), -0.15, 0.0);
    const double spare = std::min(-zmp, 0.15 + zmp);
    strategy.update(excess, spare, true);
    const double e = std::exp(omega * tick);
    const double effective = zmp + strategy.zmp_shift().x();
    dcm = effective + (dcm - effective) * e;
    outcome.greatest_angle = std::max(outcome.greatest_angle, std::abs(strategy.angle().x()));
    outcome.greatest_torque =
        std::max(outcome.greatest_torque, std::abs(strategy.zmp_shift().x()) * weight);
  }
  outcome.saved = std::abs(dcm + 0.075) < 0.01;
  outcome.last_angle = strategy.angle().x();
  return outcome;
}

TEST(HipStrategy, SavesAlmostAllThatAnyWheelCould) {
  for (const HipParameters& p : {hip(60.0, 1.0, 0.5), hip(100.0, 1.0, 0.5), hip(100.0, 2.0, 1.0)}) {
    EXPECT_TRUE(run(p, 0.9 * bound(p)).saved) << p.torque << " N m, bound " << bound(p);
    EXPECT_FALSE(run(p, 1.05 * bound(p)).saved) << p.torque << " N m, bound " << bound(p);
  }
}

TEST(HipStrategy, KeepsItsLimits) {
  const HipParameters p = hip(100.0, 1.0, 0.5);
  for (const double share : {0.1, 0.5, 0.9, 2.0}) {
    const Outcome outcome = run(p, share * bound(p));
    EXPECT_LE(outcome.greatest_angle, 0.5 + 1e-9) << share;
    EXPECT_LE(outcome.greatest_torque, 100.0 + 1e-9) << share;
  }
}

TEST(HipStrategy, ComesBackUpright) {
  const HipParameters p = hip(100.0, 1.0, 0.5);
  EXPECT_LT(std::abs(run(p, 0.8 * bound(p)).last_angle), 0.01);
}

TEST(HipStrategy, DoesNothingWhileTheFeetSuffice) {
  HipStrategy strategy(hip(100.0, 1.0, 0.5), weight, omega, tick);
  for (int i = 0; i < 100; ++i) {
    strategy.update({Excess{-0.01, -0.14}, Excess{-0.03, -0.04}}, 0.01, true);
    EXPECT_EQ(strategy.zmp_shift(), Vec2::Zero());
  }
}

TEST(HipStrategy, IsStillWhenItIsSwitchedOff) {
  HipStrategy strategy(hip(100.0, 1.0, 0.5), weight, omega, tick);
  strategy.update({Excess{0.1, -0.2}, Excess{-1.0, -1.0}}, 0.0, false);
  EXPECT_EQ(strategy.zmp_shift(), Vec2::Zero());
}

}  // namespace
}  // namespace stagger::engine
