#include "engine/footholds.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "engine/lipm.h"
#include "tests/engine/point_mass_walk.h"

namespace stagger::engine {
namespace {

using testing::Walk;

/// Distance to the nearest edge, negative outside [m].
double margin(const FootholdRegion& region, const Vec2& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < region.count; ++i) {
    const Vec2 edge = (region.corners[(i + 1) % region.count] - region.corners[i]).normalized();
    const Vec2 away = point - region.corners[i];
    least = std::min(least, edge.x() * away.y() - edge.y() * away.x());
  }
  return least;
}

Vec2 centre(const FootholdRegion& region) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& corner : region.view()) sum += corner;
  return sum / static_cast<double>(region.count);
}

/// A step whose every part is turned and shifted, so that nothing cancels.
class Step {
 public:
  Step() {
    situation.stance = {{1.0, -0.4}, 0.3, Side::left};
    situation.planned = {{1.3, -0.5}, 0.5, Side::right};
    situation.dcm = {1.08, -0.46};
    situation.transfer = transfer_factor(demand.t_ds, demand.omega);
    for (const Vec2& corner : {Vec2(-0.1, -0.04), Vec2(0.1, -0.04), Vec2(0.1, 0.04)}) {
      zmp.push_back(situation.stance.position + rotated(corner, situation.stance.yaw));
    }
    demand.zmp = zmp;
    demand.viable = &viable;
  }

  /// How far inside of what is viable the DCM can be at the next lift-off, with the foot put down
  /// at this place: over all ZMPs on a grid, the double support integrated in small steps.
  double best_margin(const Vec2& foothold) const {
    constexpr int grid = 12;
    double best = -std::numeric_limits<double>::infinity();
    for (int i = 0; i <= grid; ++i) {
      for (int j = 0; i + j <= grid; ++j) {
        const double a = static_cast<double>(i) / grid;
        const double b = static_cast<double>(j) / grid;
        const Vec2 p = a * zmp[0] + b * zmp[1] + (1.0 - a - b) * zmp[2];
        Vec2 dcm = dcm_after(situation.dcm, p, demand.left, demand.omega);
        constexpr int parts = 200;
        for (int k = 0; k < parts; ++k) {
          const Vec2 moving = situation.stance.position +
                              (k + 0.5) / parts * (foothold - situation.stance.position);
          dcm = dcm_after(dcm, moving, demand.t_ds / parts, demand.omega);
        }
        const Vec2 local = rotated(dcm - foothold, -situation.planned.yaw);
        best = std::max(best, viable.margin(local));
      }
    }
    return best;
  }

  StepSituation situation;
  CaptureDemand demand{.left = 0.25, .t_ds = 0.12, .omega = 3.2, .zmp = {}};
  std::vector<Vec2> zmp;
  ConvexPolygon viable{std::array<Vec2, 5>{Vec2(-0.25, 0.02), Vec2(-0.1, -0.1), Vec2(0.2, -0.05),
                                           Vec2(0.3, 0.1), Vec2(0.0, 0.2)}};
};

TEST(Footholds, CaptureWhatSomeZmpAndSomeViableDcmCapture) {
  const Step step;
  const FootholdRegion region = capturing_footholds(step.situation, step.demand);
  EXPECT_EQ(region.count, 8U);  // edges of a triangle and of a pentagon
  for (const Vec2& corner : region.view()) {
    const Vec2 outwards = (corner - centre(region)).normalized();
    EXPECT_GT(step.best_margin(corner - 0.01 * outwards), 0.0);
    EXPECT_LT(step.best_margin(corner + 0.01 * outwards), 0.0);
  }
}

TEST(Footholds, AreCountedCounterClockwise) {
  const Step step;
  const FootholdRegion region = capturing_footholds(step.situation, step.demand);
  EXPECT_GT(margin(region, centre(region)), 0.05);
}

TEST(Footholds, WithoutViableDcmThereAreNone) {
  Step step;
  const ConvexPolygon nothing;
  step.demand.viable = &nothing;
  EXPECT_EQ(capturing_footholds(step.situation, step.demand).count, 0U);
}

TEST(Footholds, OfAFootTurnWithIt) {
  const ConvexPolygon triangle(std::array<Vec2, 3>{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)});
  const FootholdRegion region =
      in_world(triangle, {{2.0, 3.0}, std::numbers::pi / 2.0, Side::left});
  ASSERT_EQ(region.count, 3U);
  EXPECT_NEAR(margin(region, {2.0, 4.0}), 0.0, 1e-12);
  EXPECT_NEAR(margin(region, {1.0, 3.0}), 0.0, 1e-12);
}

TEST(Footholds, OfAWalkAreThereWhileAFootIsInTheAir) {
  Walk walk;
  const WalkingEngine& engine = walk.engine();
  std::array<Vec3, 5> path;
  walk.run(0.5);
  EXPECT_EQ(engine.reachable_footholds().count, 0U);
  EXPECT_EQ(engine.foothold_demand().count, 0U);
  EXPECT_EQ(engine.swing_path(path), 0U);

  walk.engine().walk({0.2, 0.0, 0.0});
  int looked_at = 0;
  for (int i = 0; i < 300; ++i) {
    walk.run(0.01);
    const WalkingTargets& targets = engine.targets();
    if (targets.state != WalkingState::single_support) continue;
    if (targets.t_ss - targets.phase_time < 0.02) continue;
    ++looked_at;
    // What it walks is captured and reached all along.
    const Vec2& step = targets.adjusted_step.position;
    EXPECT_GT(margin(engine.foothold_demand(), step), 0.0);
    EXPECT_GT(margin(engine.reachable_footholds(), step), -1e-9);
    ASSERT_EQ(engine.swing_path(path), path.size());
    EXPECT_LT((path.back().head<2>() - step).norm(), 1e-6);
    EXPECT_EQ(targets.planned_t_ss, engine.parameters().t_ss);
  }
  EXPECT_GT(looked_at, 50);
}

}  // namespace
}  // namespace stagger::engine
