#include <gtest/gtest.h>

#include "engine/capturability.h"
#include "engine/step_limits.h"
#include "engine/walking_engine.h"

namespace stagger::engine {
namespace {

TEST(UsableSole, EndsAtTheSolesEdgeOrWhereTheAnkleEnds) {
  Parameters p;
  p.sole_margin = 0.005;
  EXPECT_DOUBLE_EQ(usable_sole(p).half_length, 0.07);
  EXPECT_DOUBLE_EQ(usable_sole(p).half_width, 0.0325);
  p.ankle_reach = {0.02, 0.5};
  EXPECT_DOUBLE_EQ(usable_sole(p).half_length, 0.02);
  EXPECT_DOUBLE_EQ(usable_sole(p).half_width, 0.0325);
  EXPECT_DOUBLE_EQ(whole_sole(p).half_length, 0.075);
  const StepAbility ability = step_ability(p, ReachRegion(p), true);
  EXPECT_DOUBLE_EQ(ability.sole[2].x(), 0.02);
}

TEST(UsableSole, HoldsTheZmpOfARobotThatIsPushed) {
  Parameters p;
  p.ankle_reach = {0.02, 0.01};
  Measurement measurement;
  measurement.com = {0.0, 0.0, p.com_height};
  measurement.feet[0].position = {0.0, 0.1, 0.0};
  measurement.feet[1].position = {0.0, -0.1, 0.0};
  measurement.foot_load = {147.0, 147.0};
  WalkingEngine engine(p, measurement);
  measurement.com_velocity = {0.5, 0.5, 0.0};  // a DCM far beyond the soles
  Vec2 zmp = Vec2::Zero();
  for (int i = 0; i < 50; ++i) zmp = engine.update(measurement).zmp_command;
  EXPECT_NEAR(zmp.x(), 0.02, 1e-9);
  EXPECT_NEAR(zmp.y(), 0.11, 1e-9);
}

}  // namespace
}  // namespace stagger::engine
