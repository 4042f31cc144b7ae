#include "sim/experiment/peers/capture_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/noise.h"

namespace stagger::sim {
namespace {

using engine::Side;
using engine::Vec2;

/// Steps up to `length` forward and back, feet `near` to `far` apart.
PointWalker walker(double length, double near, double far) {
  const std::array<Vec2, 4> corners{Vec2(-length, -far), Vec2(length, -far), Vec2(length, -near),
                                    Vec2(-length, -near)};
  return {std::sqrt(9.81 / 0.88), 0.2, 0.8, engine::ReachRegion(engine::ConvexPolygon(corners))};
}

TEST(CaptureSet, IsTheClosedFormOfShortestStepsForABox) {
  const PointWalker w = walker(0.5, 0.1, 0.6);
  const CaptureSet set(w);
  // Shortest steps for ever: x = (length + x) / E; towards the swing foot y = (far + z) / E, and
  // across the stance foot z = (y - near) / E.
  const double e = std::exp(w.omega * w.t_min);
  const double x = 0.5 / (e - 1.0);
  const double y = (0.6 * e - 0.1) / (e * e - 1.0);
  const double z = (y - 0.1) / e;
  ASSERT_EQ(set.polygon(Side::left).size(), 4u);
  for (const double sign : {1.0, -1.0}) {
    EXPECT_NEAR(set.margin(Side::left, {sign * x, 0.0}), 0.0, 1e-12);
  }
  EXPECT_NEAR(set.margin(Side::left, {0.0, -y}), 0.0, 1e-12);
  EXPECT_NEAR(set.margin(Side::left, {0.0, z}), 0.0, 1e-12);
  EXPECT_NEAR(set.margin(Side::right, {0.0, y}), 0.0, 1e-12);
}

TEST(CaptureSet, IsWhatSimulationFinds) {
  const PointWalker w = walker(0.5, 0.1, 0.6);
  const CaptureSet set(w);
  Noise noise(1);
  int inside = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec2 offset(0.4 * noise(), 0.3 * noise());
    for (const Side side : {Side::left, Side::right}) {
      const double margin = set.margin(side, offset);
      EXPECT_EQ(walks_on(w, side, offset), margin >= 0.0) << offset.transpose() << ' ' << margin;
      inside += margin >= 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 500);
  EXPECT_LT(inside, 1500);
}

TEST(CaptureSet, TellsWhatTheStepUnderWayCanStillDo) {
  const PointWalker w = walker(0.5, 0.1, 0.6);
  const CaptureSet set(w);
  // With a whole step's time ahead it is the set of touchdown itself.
  for (const Vec2& offset : {Vec2(0.1, -0.2), Vec2(0.5, 0.0), Vec2(0.0, 0.2)}) {
    EXPECT_NEAR(set.margin(Side::left, offset, w.t_min, w.t_max), set.margin(Side::left, offset),
                1e-12);
  }
  EXPECT_GT(set.margin(Side::left, {0.6, 0.0}, 0.05, w.t_max), 0.0);
  EXPECT_LT(set.margin(Side::left, {0.6, 0.0}, 0.2, w.t_max), 0.0);
}

TEST(CaptureSet, HoldsEveryWayIntoItselfWhenTheTimeMattersToo) {
  // Feet that never come near: the DCM near the stance foot can only be caught late.
  const PointWalker w = walker(0.1, 0.25, 0.3);
  const CaptureSet set(w);
  EXPECT_LT(set.margin(Side::left, Vec2::Zero()), 0.0);
  std::mt19937_64 random(2);
  const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const engine::ConvexSet& landed = set.polygon(Side::right);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 step(0.1 * (2.0 * share() - 1.0), -0.25 - 0.05 * share());
    const double part = share();
    const Vec2 after =
        part * landed[random() % landed.size()] + (1.0 - part) * landed[random() % landed.size()];
    const double time = w.t_min + share() * (w.t_max - w.t_min);
    EXPECT_GE(set.margin(Side::left, std::exp(-w.omega * time) * (step + after)), -1e-12);
  }
}

}  // namespace
}  // namespace stagger::sim
