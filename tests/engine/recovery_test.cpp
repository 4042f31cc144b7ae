#include "engine/recovery.h"

#include <gtest/gtest.h>

#include "engine/lipm.h"

namespace stagger::engine {
namespace {

PerFoot<FootPose> side_by_side(double width = 0.2) {
  PerFoot<FootPose> feet;
  feet[0].position = {0.0, 0.5 * width, 0.0};
  feet[1].position = {0.0, -0.5 * width, 0.0};
  return feet;
}

Recovery recovery(const Parameters& parameters = {}) {
  return Recovery(parameters, ReachRegion(parameters));
}

TEST(Recovery, IsNeededOutsideOfTheSoles) {
  const Recovery r = recovery();
  for (const auto& [dcm, lost] : {std::pair{Vec2(0.074, 0.0), false},
                                  {Vec2(0.076, 0.0), true},
                                  {Vec2(-0.076, 0.0), true},
                                  {Vec2(0.0, 0.137), false},
                                  {Vec2(0.0, 0.138), true},
                                  {Vec2(0.0, -0.138), true}}) {
    EXPECT_EQ(r.needed(dcm, 0.0, side_by_side(), {}), lost) << dcm.transpose();
  }
}

TEST(Recovery, IsNotNeededWhereTheDcmMayBeInsideAfterAll) {
  const Recovery r = recovery();
  EXPECT_FALSE(r.needed({0.09, 0.0}, 0.005, side_by_side(), {}));
  EXPECT_TRUE(r.needed({0.09, 0.0}, 0.001, side_by_side(), {}));
  EXPECT_FALSE(r.needed({std::nan(""), 0.0}, 0.001, side_by_side(), {}));
}

TEST(Recovery, LeavesTheHipsWhatTheyCanDo) {
  Parameters p;
  p.hip = {.torque = 100.0, .inertia = 2.0, .angle = 1.0};  // saves 4.35 cm
  const Recovery r = recovery(p);
  EXPECT_FALSE(r.needed({0.117, 0.0}, 0.0, side_by_side(), {}));
  EXPECT_TRUE(r.needed({0.119, 0.0}, 0.0, side_by_side(), {}));
  EXPECT_TRUE(r.needed({0.117, 0.0}, 0.0, side_by_side(), {.hip = false}));
}

TEST(Recovery, SolesThatOverlapCannotStep) {
  EXPECT_FALSE(recovery().needed({0.3, 0.0}, 0.0, side_by_side(0.0), {}));
  EXPECT_FALSE(recovery().needed({0.3, 0.0}, 0.0, side_by_side(0.07), {}));
  EXPECT_TRUE(recovery().needed({0.3, 0.0}, 0.0, side_by_side(0.08), {}));
}

TEST(Recovery, StepsWithTheFootOnTheSideOfThePush) {
  const Recovery r = recovery();
  for (const double x : {-0.2, 0.0, 0.2}) {
    EXPECT_EQ(r.support_side({x, 0.15}, side_by_side(), true), Side::right) << x;
    EXPECT_EQ(r.support_side({x, -0.15}, side_by_side(), true), Side::left) << x;
  }
}

TEST(Recovery, StepsWithTheOtherFootWhereThatOneSavesMore) {
  // The right foot stands far off: from there the left one does not reach the DCM.
  PerFoot<FootPose> feet = side_by_side();
  feet[1].position.y() = -0.45;
  EXPECT_EQ(recovery().support_side({0.0, 0.15}, feet, true), Side::left);
}

TEST(Recovery, TurnsWithTheFeet) {
  const Recovery r = recovery();
  PerFoot<FootPose> feet = side_by_side();
  for (FootPose& foot : feet) {
    foot.position.head<2>() = rotated(foot.position.head<2>(), 1.0);
    foot.yaw = 1.0;
  }
  EXPECT_EQ(r.support_side(rotated({0.1, 0.15}, 1.0), feet, true), Side::right);
  EXPECT_TRUE(r.needed(rotated({0.076, 0.0}, 1.0), 0.0, feet, {}));
  EXPECT_FALSE(r.needed(rotated({0.074, 0.0}, 1.0), 0.0, feet, {}));
}

TEST(Recovery, NeverStepsBothFarAndWide) {
  Parameters p;
  const Recovery r = recovery(p);
  const ConvexPolygon& region = r.reach().polygon(Side::left);
  const ConvexPolygon box = ReachRegion(p).polygon(Side::left);
  for (std::size_t i = 0; i < region.size(); ++i) {
    const Vec2 corner = region.vertex(i);
    EXPECT_GE(box.margin(corner), -1e-9) << corner.transpose();
    if (-corner.y() < p.stance_width) continue;
    const Vec2 place(corner.x() / p.max_step_length,
                     (corner.y() + p.stance_width) / (p.max_step_width - p.stance_width));
    EXPECT_LE(place.norm(), 1.0 + 1e-9) << corner.transpose();
  }
  // As long, as wide and as narrow as ever.
  for (const Vec2& end : {Vec2(0.95, -0.2), Vec2(-0.95, -0.1), Vec2(0.0, -0.6)}) {
    EXPECT_GE(region.margin(end), -1e-9) << end.transpose();
  }
}

TEST(Recovery, OwnRegionsAreOnlyCutDown) {
  const std::array<Vec2, 5> corners{Vec2(-0.2, -0.15), Vec2(0.3, -0.15), Vec2(0.4, -0.3),
                                    Vec2(0.1, -0.5), Vec2(-0.3, -0.3)};
  const ConvexPolygon own(corners);
  const Recovery r{Parameters(), ReachRegion(own)};
  const ConvexPolygon& region = r.reach().polygon(Side::left);
  EXPECT_GE(region.size(), 3U);
  for (std::size_t i = 0; i < region.size(); ++i) EXPECT_GE(own.margin(region.vertex(i)), -1e-8);
}

TEST(Recovery, KnowsWhetherALastStepEndsWell) {
  Parameters p;
  const Recovery r = recovery(p);
  const double omega = natural_frequency(p);
  constexpr double left = 0.2;
  StepSituation step;
  step.stance = {{0.0, 0.1}, 0.0, Side::left};
  step.planned = {{0.0, -0.1}, 0.0, Side::right};
  // The best that a ZMP of the stance sole can do, by trying many.
  for (double x = -0.2; x <= 0.2; x += 0.01) {
    for (double y = -0.2; y <= 0.2; y += 0.01) {
      step.dcm = {x, y};
      bool saved = false;
      for (double zx = -0.075; zx < 0.076; zx += 0.0025) {
        for (double zy = 0.0625; zy < 0.138; zy += 0.0025) {
          const Vec2 end = dcm_after(step.dcm, {zx, zy}, left, omega);
          saved = saved || r.can_stand(end, side_by_side());
        }
      }
      // Beside the border; the ZMPs tried lie up to 2 mm from the best.
      const auto told = [&](double scale) {
        StepSituation other = step;
        const Vec2 centre(0.0, 0.05);
        other.dcm = centre + scale * (step.dcm - centre);
        return r.will_stand(other, left, omega);
      };
      EXPECT_EQ(told(saved ? 0.97 : 1.05), saved) << step.dcm.transpose();
    }
  }
}

}  // namespace
}  // namespace stagger::engine
