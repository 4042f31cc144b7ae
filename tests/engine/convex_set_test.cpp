#include "engine/convex_set.h"

#include <gtest/gtest.h>

#include <random>

namespace stagger::engine {
namespace {

const ConvexSet square{{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}};

double support(const ConvexSet& set, const Vec2& direction) {
  double most = -1e300;
  for (const Vec2& p : set) most = std::max(most, direction.dot(p));
  return most;
}

TEST(ConvexSet, HullLeavesOutWhatIsInsideOrOnAnEdge) {
  std::vector<Vec2> points = square;
  points.insert(points.end(), {{0.0, 0.0}, {1.0, 0.5}, {-1.0, -1.0}});
  const ConvexSet hull = convex_hull(points);
  EXPECT_EQ(hull.size(), 4U);
  EXPECT_DOUBLE_EQ(margin(hull, {0.0, 0.0}), 1.0);
  EXPECT_DOUBLE_EQ(margin(hull, {1.5, 0.0}), -0.5);
}

// h(A + B) = h(A) + h(B) in every direction: what a Minkowski sum is.
TEST(ConvexSet, SumsAddTheirExtents) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  const auto some = [&](int count) {
    std::vector<Vec2> points;
    for (int i = 0; i < count; ++i) points.emplace_back(place(random), place(random));
    return convex_hull(points);
  };
  for (int i = 0; i < 50; ++i) {
    const ConvexSet a = some(1 + i % 7);
    const ConvexSet b = some(5);
    const ConvexSet sum = minkowski_sum(a, b);
    for (double angle = 0.0; angle < 6.28; angle += 0.1) {
      const Vec2 direction(std::cos(angle), std::sin(angle));
      EXPECT_NEAR(support(sum, direction), support(a, direction) + support(b, direction), 1e-8);
    }
  }
}

TEST(ConvexSet, ARayLeavesWhereItCrossesTheFarEdge) {
  EXPECT_DOUBLE_EQ(ray_exit(square, {1.0, 0.0}), 1.0);
  EXPECT_NEAR(ray_exit(square, Vec2(1.0, 1.0).normalized()), std::sqrt(2.0), 1e-12);
  const ConvexSet ahead = shifted(square, {3.0, 0.0});
  EXPECT_DOUBLE_EQ(ray_exit(ahead, {1.0, 0.0}), 4.0);
  EXPECT_LT(ray_exit(ahead, {-1.0, 0.0}), 0.0);
  EXPECT_LT(ray_exit(ahead, {0.0, 1.0}), 0.0);
}

TEST(ConvexSet, TheMirrorImageKeepsItsSense) {
  const ConvexSet image = mirrored(shifted(square, {0.0, 3.0}));
  EXPECT_DOUBLE_EQ(margin(image, {0.0, -3.0}), 1.0);
}

}  // namespace
}  // namespace stagger::engine
