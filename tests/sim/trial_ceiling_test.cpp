#include "sim/experiment/trial_ceiling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/experiment/push_ceiling.h"
#include "tests/sim/kasaei.h"

namespace stagger::sim {
namespace {

TrialSpec pushed(const Vec3& direction, double duration, bool step, bool time) {
  TrialSpec spec;
  spec.strategies = {.ankle = true, .hip = false, .step = step, .time = time};
  PushSpec push;
  push.direction = direction;
  push.duration_s = duration;
  push.impulse_ns = 1.0;
  push.trigger = PhaseTrigger{WalkingState::single_support, Side::left, 0.25};
  spec.push = push;
  return spec;
}

double ceiling(const TrialSpec& spec) { return trial_ceiling(spec, *kasaei()).value(); }

const double omega = std::sqrt(9.81);  // kasaei: CoM at 1 m
constexpr double half_length = 0.075;
constexpr double half_width = 0.0375;

/// Of delta-v, as DCM at the push's beginning: what counts of a push that is not a blow.
double felt(double duration) { return (1.0 - std::exp(-omega * duration)) / (omega * duration); }

TEST(TrialCeiling, OfTheAnkleForwardIsTheSoleItself) {
  for (const double duration : {0.001, 0.1}) {
    EXPECT_NEAR(ceiling(pushed(Vec3::UnitX(), duration, false, false)),
                half_length * omega / felt(duration), 1e-9);
  }
}

TEST(TrialCeiling, OfStepsForwardIsTheGeometricSeries) {
  // d <- h + (l + (d - h) e^{-w Tds}) e^{-w T}, with 0.27 s of 0.36 s left for the first step.
  const double step = 0.64;
  const double transfer = std::exp(-omega * 0.04);
  double d = half_length;
  for (int i = 0; i < 60; ++i) {
    d = half_length + (step + (d - half_length) * transfer) * std::exp(-omega * 0.36);
  }
  d = half_length + (step + (d - half_length) * transfer) * std::exp(-omega * 0.27);
  EXPECT_NEAR(ceiling(pushed(Vec3::UnitX(), 0.05, true, false)), d * omega / felt(0.05), 1e-6);
}

TEST(TrialCeiling, AWalkForwardHasLessLeftInFrontThanBehind) {
  TrialSpec ahead = pushed(Vec3::UnitX(), 0.01, true, false);
  TrialSpec back = pushed(-Vec3::UnitX(), 0.01, true, false);
  const double ahead_in_place = ceiling(ahead);
  const double back_in_place = ceiling(back);
  ahead.walk.vx = back.walk.vx = 0.3;
  EXPECT_LT(ceiling(ahead), ahead_in_place);
  EXPECT_GT(ceiling(back), back_in_place);
  // The DCM is as far ahead of what it is in place as there is less room.
  EXPECT_NEAR(ceiling(ahead) + ceiling(back), ahead_in_place + back_in_place, 1e-9);
}

TEST(TrialCeiling, SidewaysTheStanceFootsSideIsTheWorse) {
  const double outward = ceiling(pushed(-Vec3::UnitY(), 0.01, true, true));
  const double inward = ceiling(pushed(Vec3::UnitY(), 0.01, true, true));
  EXPECT_GT(outward, 1.5 * inward);
  TrialSpec either = pushed(Vec3::UnitY(), 0.01, true, true);
  std::get<PhaseTrigger>(either.push->trigger).leg.reset();
  EXPECT_NEAR(ceiling(either), outward, 1e-9);
}

TEST(TrialCeiling, StandingIsTheHullOfBothSoles) {
  TrialSpec spec = pushed(Vec3::UnitX(), 0.01, false, false);
  spec.stand = true;
  spec.push->trigger = Immediate{};
  EXPECT_NEAR(ceiling(spec), half_length * omega / felt(0.01), 1e-9);
  spec.push->direction = Vec3::UnitY();
  EXPECT_NEAR(ceiling(spec), (0.1 + half_width) * omega / felt(0.01), 1e-9);
  // Steps add a little sideways, where the feet stand apart already, and much ahead.
  const double soles = ceiling(spec);
  spec.strategies.step = true;
  EXPECT_GT(ceiling(spec), 1.1 * soles);
  spec.push->direction = Vec3::UnitX();
  EXPECT_GT(ceiling(spec), 1.5 * soles);
}

TEST(TrialCeiling, IsUnknownWhereNothingIsDerived) {
  const TrialSpec known = pushed(Vec3::UnitX(), 0.01, true, true);
  ASSERT_TRUE(trial_ceiling(known, *kasaei()));
  const auto unknown = [&](const auto& change) {
    TrialSpec spec = known;
    change(spec);
    return !trial_ceiling(spec, *kasaei());
  };
  EXPECT_TRUE(unknown([](TrialSpec& spec) { spec.push.reset(); }));
  EXPECT_TRUE(unknown([](TrialSpec& spec) { spec.push->profile = PushProfile::half_sine; }));
  EXPECT_TRUE(unknown([](TrialSpec& spec) { spec.push->direction = Vec3(0.8, 0.0, 0.6); }));
  EXPECT_TRUE(unknown([](TrialSpec& spec) { spec.push->trigger = Immediate{}; }));
  EXPECT_TRUE(unknown([](TrialSpec& spec) {
    spec.push->trigger = PhaseTrigger{WalkingState::double_support, Side::left, 0.5};
  }));
  EXPECT_TRUE(unknown([](TrialSpec& spec) { spec.walk.wz = 0.1; }));
  EXPECT_FALSE(unknown([](TrialSpec& spec) { spec.walk.vy = 0.1; }));
  EXPECT_TRUE(unknown([](TrialSpec& spec) {
    spec.walk.vy = 0.1;
    spec.strategies.step = false;
  }));
}

TEST(DeltaVCeiling, OfABlowIsTheRoomTimesTheFrequency) {
  const engine::ConvexSet room{{-0.1, -0.1}, {0.3, -0.1}, {0.3, 0.1}, {-0.1, 0.1}};
  const auto along = [&](const Vec2& direction) {
    return delta_v_ceiling(room, Vec2(0.1, 0.0), direction, 1e-9, 3.0);
  };
  EXPECT_NEAR(along({1.0, 0.0}), 0.6, 1e-6);
  EXPECT_NEAR(along({0.0, 1.0}), 0.3, 1e-6);
}

}  // namespace
}  // namespace stagger::sim
