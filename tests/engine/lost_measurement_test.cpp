// Sensors that fail for a while: NaN, infinity, nonsense. The engine has to live through it.
#include <gtest/gtest.h>

#include <limits>

#include "tests/engine/point_mass_walk.h"

namespace stagger::engine {
namespace {

using testing::quick;
using testing::Walk;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

bool finite(const WalkingTargets& t) {
  bool all = t.com_reference.allFinite() && t.dcm_reference.allFinite() &&
             t.zmp_command.allFinite() && t.dcm_estimate.allFinite() && t.zmp_shift.allFinite() &&
             std::isfinite(t.heading);
  for (const FootTarget& foot : t.feet) {
    all = all && foot.position.allFinite() && std::isfinite(foot.yaw);
  }
  return all;
}

/// Every part of a measurement, made useless one after the other.
void spoil(Measurement& m, int part, double value) {
  switch (part) {
    case 0:
      m.com.x() = value;
      break;
    case 1:
      m.com_velocity.y() = value;
      break;
    case 2:
      m.feet[0].position.y() = value;
      break;
    case 3:
      m.feet[1].yaw = value;
      break;
    case 4:
      m.foot_load = {value, value};
      break;
    default:
      m.zmp.x() = value;
      m.com.setConstant(value);
      m.com_velocity.setConstant(value);
      m.foot_load = {value, value};
      for (FootPose& foot : m.feet) {
        foot.position.setConstant(value);
        foot.yaw = value;
      }
  }
}

TEST(LostMeasurement, ShortGapsAreBridgedAtAnyPhase) {
  for (const double value : {nan, infinity, -infinity, 1e300}) {
    for (int part = 0; part < 6; ++part) {
      Walk walk;
      walk.engine().walk({0.2, 0.05, 0.1});
      walk.run(2.0);
      walk.forget();
      for (int i = 0; i < 3000; ++i) {
        // Three ticks of every fifty; 49 and the step time have no common factor.
        walk.set_sensors([&](Measurement& m) {
          if (i % 49 < 3) spoil(m, part, value);
        });
        walk.run(0.001);
        ASSERT_TRUE(finite(walk.engine().targets())) << part << ", " << value << ", tick " << i;
      }
      EXPECT_LT(walk.worst_error(), 3e-3) << part << ", " << value;
      EXPECT_GE(walk.engine().targets().step_count, 7U) << part << ", " << value;
    }
  }
}

TEST(LostMeasurement, BlindTheEngineGoesOnByItsModel) {
  Walk walk;
  walk.engine().walk({0.2, 0.0, 0.0});
  walk.run(2.0);
  walk.set_sensors([](Measurement& m) { m.com.setConstant(nan); });
  walk.run(0.5);
  EXPECT_LT((walk.dcm() - walk.engine().targets().dcm_reference).norm(), 0.01);
}

TEST(LostMeasurement, FromTheFirstTickOn) {
  Walk walk;
  walk.set_sensors([](Measurement& m) { spoil(m, 5, nan); });
  walk.engine().walk({});
  walk.run(0.1);
  EXPECT_TRUE(finite(walk.engine().targets()));
  walk.set_sensors({});
  walk.run(5.0);
  EXPECT_LT((walk.dcm() - walk.engine().targets().dcm_reference).norm(), 5e-3);
}

TEST(LostMeasurement, ALongBlindnessEndsWithNeitherCrashNorHang) {
  Walk walk;
  walk.engine().walk({0.2, 0.0, 0.0});
  walk.run(1.0);
  walk.push({0.5, 0.3});
  walk.set_sensors([](Measurement& m) { spoil(m, 5, nan); });
  for (int i = 0; i < 400; ++i) {
    walk.run(1.0);
    ASSERT_TRUE(finite(walk.engine().targets())) << i;
  }
  EXPECT_GT(walk.engine().targets().step_count, 0U);
}

}  // namespace
}  // namespace stagger::engine
