#include "server/http/rate_limiter.h"

#include <gtest/gtest.h>

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

const RateLimiter::Clock::time_point first_moment{};

TEST(RateLimiter, ABurstPassesThenItsRate) {
  RateLimiter limiter(10.0, 3.0);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(limiter.take("a", first_moment));
  EXPECT_EQ(limiter.take("a", first_moment), 1);
  EXPECT_FALSE(limiter.take("a", first_moment + 100ms));
  EXPECT_TRUE(limiter.take("a", first_moment + 100ms));
  for (int i = 0; i < 3; ++i)
    EXPECT_FALSE(limiter.take("a", first_moment + 1h)) << "no more than a burst";
  EXPECT_TRUE(limiter.take("a", first_moment + 1h));
}

TEST(RateLimiter, TellsHowLongToWait) {
  RateLimiter limiter(0.5, 1.0);
  EXPECT_FALSE(limiter.take("a", first_moment));
  EXPECT_EQ(limiter.take("a", first_moment), 2);
  EXPECT_EQ(limiter.take("a", first_moment + 1s), 1);
}

TEST(RateLimiter, AnAddressPaysForItselfAlone) {
  RateLimiter limiter(1.0, 1.0);
  EXPECT_FALSE(limiter.take("a", first_moment));
  EXPECT_TRUE(limiter.take("a", first_moment));
  EXPECT_FALSE(limiter.take("b", first_moment));
}

TEST(RateLimiter, MemoryIsBounded) {
  RateLimiter limiter(1.0, 1.0);
  for (std::size_t i = 0; i < 3 * RateLimiter::max_addresses; ++i) {
    limiter.take(std::to_string(i), first_moment);
    ASSERT_LE(limiter.addresses(), RateLimiter::max_addresses);
  }
  // Those that have been quiet go first.
  RateLimiter other(1.0, 1.0);
  for (std::size_t i = 1; i < RateLimiter::max_addresses; ++i) {
    other.take(std::to_string(i), first_moment);
  }
  other.take("busy", first_moment + 10s);
  other.take("new", first_moment + 10s);
  EXPECT_EQ(other.addresses(), 2U);
  EXPECT_TRUE(other.take("busy", first_moment + 10s));
}

}  // namespace
}  // namespace stagger::server
