#include "server/campaign/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stagger::server::campaign {
namespace {

TEST(Statistics, SharesHaveWilsonsInterval) {
  EXPECT_FALSE(share_of(0, 0));
  // Newcombe 1998, table I: 81 of 263 is 0.2553 to 0.3662, 0 of 20 up to 0.1611.
  const auto share = share_of(81, 263);
  EXPECT_NEAR(share->low, 0.2553, 5e-5);
  EXPECT_NEAR(share->high, 0.3662, 5e-5);
  EXPECT_EQ(share_of(0, 20)->low, 0.0);
  EXPECT_NEAR(share_of(0, 20)->high, 0.1611, 5e-5);
}

TEST(Statistics, NoDifferenceLiesWithinItsInterval) {
  const auto same = paired_difference({3, 0, 0, 97});
  EXPECT_EQ(same->value, 0.0);
  EXPECT_LT(same->low, 0.0);
  EXPECT_GT(same->high, 0.0);
  EXPECT_FALSE(paired_difference({}));
}

TEST(Statistics, PairedDifferenceIsOfBLessA) {
  const auto worse = paired_difference({10, 2, 30, 58});
  EXPECT_NEAR(worse->value, 0.28, 1e-12);
  EXPECT_GT(worse->low, 0.15);
  EXPECT_LT(worse->high, 0.40);
  // The other way round it is the same with the opposite sign.
  const auto better = paired_difference({10, 30, 2, 58});
  EXPECT_NEAR(better->low, -worse->high, 1e-12);
  // Pairs that agree narrow the interval.
  const auto unpaired_like = paired_difference({4, 8, 36, 52});
  EXPECT_GT(unpaired_like->high - unpaired_like->low, worse->high - worse->low);
}

TEST(Statistics, MeansHaveStudentsInterval) {
  EXPECT_FALSE(mean_of({}));
  EXPECT_TRUE(std::isinf(mean_of({2.0})->high));
  // Of 1..5: mean 3, standard error sqrt(0.5), t(4) 2.776.
  const auto mean = mean_of({1, 2, 3, 4, 5});
  EXPECT_EQ(mean->value, 3.0);
  EXPECT_NEAR(mean->high - 3.0, 2.776 * std::sqrt(0.5), 0.01);
  EXPECT_NEAR(mean_of({0, 1})->high - 0.5, 12.706 * 0.5, 0.001);
}

}  // namespace
}  // namespace stagger::server::campaign
