#include "server/live/pacer.h"

#include <gtest/gtest.h>

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

const Pacer::Time start{};

TEST(Pacer, TicksOnTimeAreNotLate) {
  Pacer pacer(1ms);
  pacer.restart(start);
  for (int i = 0; i < 3000; ++i) {
    EXPECT_EQ(pacer.due(), start + i * 1ms);
    pacer.tick(pacer.due());
  }
  EXPECT_EQ(pacer.late_ticks(), 0U);
  EXPECT_EQ(pacer.worst_lateness_ms(), 0.0);
  EXPECT_NEAR(pacer.real_time_factor(), 1.0, 0.01);
}

TEST(Pacer, GoesAtTheSpeedThatIsAskedFor) {
  Pacer pacer(1ms);
  pacer.set_speed(0.01, start);
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(pacer.due(), start + i * 100ms);
    pacer.tick(pacer.due());
  }
  EXPECT_NEAR(pacer.real_time_factor(), 0.01, 0.002);
  pacer.set_speed(4.0, start);
  pacer.tick(start);
  EXPECT_EQ(pacer.due(), start + 250us);
  EXPECT_EQ(pacer.late_ticks(), 0U);
}

TEST(Pacer, AsFastAsItGoesNoTickIsLate) {
  Pacer pacer(1ms);
  pacer.set_speed(std::nullopt, start);
  Pacer::Time now = start;
  for (int i = 0; i < 3000; ++i) {
    EXPECT_LE(pacer.due(), now);
    pacer.tick(now);
    now += 10ms;
  }
  EXPECT_EQ(pacer.late_ticks(), 0U);
  EXPECT_NEAR(pacer.real_time_factor(), 0.1, 0.01);
}

TEST(Pacer, CatchesUpWithAShortStall) {
  Pacer pacer(1ms);
  pacer.restart(start);
  pacer.tick(start + 30ms);
  // Thirty ticks are due at once; after them time is as it should be.
  for (int i = 1; i <= 30; ++i) {
    EXPECT_LE(pacer.due(), start + 30ms);
    pacer.tick(start + 30ms);
  }
  EXPECT_EQ(pacer.due(), start + 31ms);
  EXPECT_EQ(pacer.late_ticks(), 25U);
  EXPECT_EQ(pacer.worst_lateness_ms(), 30.0);
}

TEST(Pacer, GivesUpTheTimeOfALongStall) {
  Pacer pacer(1ms);
  pacer.restart(start);
  pacer.tick(start + 2s);
  EXPECT_EQ(pacer.due(), start + 2s + 1ms);
  EXPECT_EQ(pacer.late_ticks(), 1U);
  EXPECT_EQ(pacer.worst_lateness_ms(), 2000.0);
}

TEST(Pacer, AWorldThatIsTooSlowRunsAtItsOwnPace) {
  Pacer pacer(1ms);
  pacer.restart(start);
  Pacer::Time now = start;
  for (int i = 0; i < 2000; ++i) {
    now = std::max(now, pacer.due());
    pacer.tick(now);
    now += 4ms;  // a tick takes four times as long as it simulates
  }
  EXPECT_NEAR(pacer.real_time_factor(), 0.25, 0.01);
  EXPECT_LE(pacer.worst_lateness_ms(), 55.0);
}

TEST(Pacer, APauseIsNotLateness) {
  Pacer pacer(1ms);
  pacer.restart(start);
  pacer.tick(start);
  pacer.restart(start + 1h);
  pacer.tick(start + 1h);
  EXPECT_EQ(pacer.late_ticks(), 0U);
}

}  // namespace
}  // namespace stagger::server
