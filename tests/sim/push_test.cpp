#include "sim/plant/push.h"

#include <gtest/gtest.h>

#include "tests/sim/tick.h"

namespace stagger::sim {
namespace {

PushSpec push(double impulse, double duration) {
  PushSpec spec;
  spec.impulse_ns = impulse;
  spec.duration_s = duration;
  return spec;
}

/// What a schedule delivered in `ticks` ticks of a robot that stands.
Vec3 deliver(PushSchedule& schedule, int ticks, const GaitPhase& phase = {}) {
  Vec3 impulse = Vec3::Zero();
  for (int i = 0; i < ticks; ++i) {
    for (const AppliedForce& force : schedule.forces(i, i * dt, dt, phase)) {
      impulse += force.force * dt;
    }
  }
  return impulse;
}

TEST(Push, DeliversItsImpulseWhateverProfileAndDuration) {
  for (const PushProfile profile : {PushProfile::rectangular, PushProfile::half_sine}) {
    for (const double duration : {0.001, 0.0025, 0.05, 0.1237}) {
      PushSchedule schedule;
      PushSpec spec = push(6.0, duration);
      spec.profile = profile;
      schedule.add(spec, 0);
      EXPECT_NEAR(deliver(schedule, 300).x(), 6.0, 1e-12) << duration;
      EXPECT_EQ(schedule.records()[0].state, PushState::done);
      EXPECT_NEAR(schedule.records()[0].delivered.norm(), 6.0, 1e-12);
    }
  }
}

TEST(Push, ActsForItsDurationAndNoLonger) {
  PushSchedule schedule;
  schedule.add(push(5.0, 0.05), 0);
  int acting = 0;
  for (int i = 0; i < 200; ++i) acting += schedule.forces(i, i * dt, dt, {}).empty() ? 0 : 1;
  EXPECT_EQ(acting, 50);
}

TEST(Push, TurnsWithTheHeadingOfItsStart) {
  PushSchedule schedule;
  schedule.add(push(2.0, 0.01), 0);
  GaitPhase phase;
  phase.heading = M_PI / 2;
  const Vec3 delivered = deliver(schedule, 20, phase);
  EXPECT_LT((delivered - Vec3(0.0, 2.0, 0.0)).norm(), 1e-12);
}

TEST(Push, WaitsForItsTime) {
  PushSchedule schedule;
  PushSpec spec = push(1.0, 0.01);
  spec.trigger = TimeTrigger{0.05};
  schedule.add(spec, 0);
  deliver(schedule, 100);
  EXPECT_EQ(schedule.records()[0].start_tick, 50U);
}

TEST(Push, WaitsForTheNextTimeThePhaseComes) {
  PushSchedule schedule;
  PushSpec spec = push(1.0, 0.01);
  spec.trigger = PhaseTrigger{engine::WalkingState::single_support, Side::left, 0.5};
  schedule.add(spec, 0);
  GaitPhase phase;
  phase.state = engine::WalkingState::single_support;
  phase.fraction = 0.8;  // past it already: not now
  EXPECT_TRUE(schedule.forces(0, 0.0, dt, phase).empty());
  phase.support_side = Side::right;  // the other foot
  phase.fraction = 0.6;
  EXPECT_TRUE(schedule.forces(1, dt, dt, phase).empty());
  phase.support_side = Side::left;
  phase.fraction = 0.49;
  EXPECT_TRUE(schedule.forces(2, 2 * dt, dt, phase).empty());
  phase.fraction = 0.5;
  EXPECT_FALSE(schedule.forces(3, 3 * dt, dt, phase).empty());
}

TEST(Push, CanBeCancelledBeforeAndDuring) {
  PushSchedule schedule;
  PushSpec later = push(1.0, 0.01);
  later.trigger = TimeTrigger{10.0};
  const auto waiting = schedule.add(later, 0);
  const auto acting = schedule.add(push(4.0, 0.04), 0);
  for (int i = 0; i < 10; ++i) schedule.forces(i, i * dt, dt, {});
  EXPECT_TRUE(schedule.cancel(waiting, 10));
  EXPECT_TRUE(schedule.cancel(acting, 10));
  EXPECT_TRUE(schedule.forces(10, 10 * dt, dt, {}).empty());
  EXPECT_NEAR(schedule.records()[1].delivered.norm(), 1.0, 1e-12);
  EXPECT_FALSE(schedule.cancel(acting, 11)) << "it is over";
  EXPECT_FALSE(schedule.cancel(99, 11)) << "there is no such push";
}

TEST(Push, TwoAtATimeAddUp) {
  PushSchedule schedule;
  schedule.add(push(1.0, 0.01), 0);
  schedule.add(push(2.0, 0.02), 0);
  EXPECT_EQ(schedule.forces(0, 0.0, dt, {}).size(), 2U);
  PushSchedule again;
  again.add(push(1.0, 0.01), 0);
  again.add(push(2.0, 0.02), 0);
  EXPECT_NEAR(deliver(again, 50).x(), 3.0, 1e-12);
}

}  // namespace
}  // namespace stagger::sim
