#include "engine/support_polygon.h"

#include <gtest/gtest.h>

#include <numbers>

namespace stagger::engine {
namespace {

constexpr Sole small_sole{0.075, 0.0375};

TEST(SupportPolygon, OneFootIsItsSole) {
  const ConvexPolygon polygon =
      support_polygon(small_sole, {Vec3(1.0, 0.5, 0.0), std::numbers::pi / 2});
  ASSERT_EQ(polygon.size(), 4U);
  // Turned by 90 degrees the length lies along y.
  EXPECT_NEAR(polygon.margin({1.0, 0.5}), 0.0375, 1e-12);
  EXPECT_NEAR(polygon.margin({1.0, 0.5 + 0.07}), 0.005, 1e-12);
  EXPECT_NEAR(polygon.margin({1.05, 0.5}), -0.0125, 1e-12);
}

TEST(SupportPolygon, TwoFeetAreTheirHull) {
  const ConvexPolygon polygon =
      support_polygon(small_sole, {Vec3(0.0, 0.1, 0.0), 0.0}, {Vec3(0.3, -0.1, 0.0), 0.0});
  EXPECT_EQ(polygon.size(), 6U);
  EXPECT_GT(polygon.margin({0.15, 0.0}), 0.0);  // between the feet
  EXPECT_LT(polygon.margin({0.3, 0.1}), 0.0);   // no foot is there
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon.vertex((i + 1) % 6) - polygon.vertex(i);
    const Vec2 b = polygon.vertex((i + 2) % 6) - polygon.vertex((i + 1) % 6);
    EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0.0) << "counter-clockwise and convex";
  }
}

TEST(SupportPolygon, FeetSideBySideHaveNoVertexTooMany) {
  const ConvexPolygon polygon =
      support_polygon(small_sole, {Vec3(0.0, 0.1, 0.0), 0.0}, {Vec3(0.0, -0.1, 0.0), 0.0});
  EXPECT_EQ(polygon.size(), 4U);
}

TEST(SupportPolygon, ClampFindsTheNearestPoint) {
  const ConvexPolygon polygon = support_polygon(small_sole, {Vec3(0.0, 0.0, 0.0), 0.0});
  EXPECT_EQ(polygon.clamp({0.01, 0.02}), Vec2(0.01, 0.02));
  EXPECT_LT((polygon.clamp({0.2, 0.01}) - Vec2(0.075, 0.01)).norm(), 1e-12);
  EXPECT_LT((polygon.clamp({-1.0, 1.0}) - Vec2(-0.075, 0.0375)).norm(), 1e-12);
}

}  // namespace
}  // namespace stagger::engine
