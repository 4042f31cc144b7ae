// Parameters that change at every phase of the gait, on the point mass.
#include <gtest/gtest.h>

#include "tests/engine/point_mass_walk.h"

namespace stagger::engine {
namespace {

using testing::quick;
using testing::Walk;

constexpr double phase_of_change = 0.02;  // [s]

Parameters slower_and_wider() {
  Parameters p = quick();
  p.t_ss = 0.55;
  p.t_ds = 0.15;
  p.stance_width = 0.26;
  p.swing_height = 0.06;
  p.lqr_zmp_weight = 30.0;
  p.max_step_length = 0.3;
  return p;
}

class ParameterChange : public ::testing::TestWithParam<double> {
 protected:
  Parameters from() const {
    Parameters p = quick();
    p.t_ds = GetParam();
    return p;
  }
  double cycle() const { return 2.0 * (from().t_ss + from().t_ds); }
};

INSTANTIATE_TEST_SUITE_P(Gaits, ParameterChange, ::testing::Values(0.1, 0.0), [](const auto& test) {
  return test.param > 0.0 ? "Quick" : "NoDoubleSupport";
});

TEST_P(ParameterChange, AtAnyPhaseOfAWalkTheReferenceIsFollowedAndDoesNotJump) {
  const Tuning tuning(slower_and_wider());
  for (const WalkCommand& command : {WalkCommand{}, WalkCommand{0.3, 0.0, 0.0}, {0.1, 0.1, 0.2}}) {
    for (double phase = 0.0; phase < cycle(); phase += 4.5 * phase_of_change) {
      Walk walk(from());
      walk.engine().walk(command);
      walk.run(from().t_init + cycle() + phase);
      walk.forget();
      const std::uint64_t before = walk.engine().targets().step_count;
      ASSERT_TRUE(walk.engine().change(tuning));
      EXPECT_TRUE(walk.engine().change_waits()) << phase;
      walk.run(4.0);
      EXPECT_FALSE(walk.engine().change_waits()) << phase;
      EXPECT_LT(walk.worst_error(), 0.03) << command.vx << ", " << command.vy << " at " << phase;
      // A fast walk takes quicker steps.
      if (command.vx == 0.0) {
        EXPECT_NEAR(walk.engine().targets().t_ss, 0.55, 0.002);
      }
      EXPECT_EQ(walk.engine().parameters().t_ss, tuning.parameters.t_ss);
      EXPECT_EQ(walk.engine().targets().t_ds, tuning.parameters.t_ds);
      EXPECT_EQ(walk.engine().parameters().swing_height, tuning.parameters.swing_height);
      EXPECT_GT(walk.engine().targets().step_count, before + 5);
      walk.forget();
      walk.run(0.5);
      EXPECT_LT(walk.worst_error(), 2e-3) << command.vx << ", " << command.vy << " at " << phase;
      walk.engine().stop();
      walk.run(4.0);
      const auto& feet = walk.measurement().feet;
      EXPECT_EQ(walk.engine().targets().state, WalkingState::idle) << phase;
      EXPECT_NEAR((feet[0].position - feet[1].position).head<2>().norm(), 0.26, 1e-3) << phase;
    }
  }
}

TEST_P(ParameterChange, TheStepUnderWayAndTheNextAreTakenAsPlanned) {
  Walk walk(from());
  walk.engine().walk({0.2, 0.0, 0.0});
  walk.run(from().t_init + cycle() + 0.1);
  ASSERT_EQ(walk.engine().targets().state, WalkingState::single_support);
  const std::uint64_t landed = walk.engine().targets().step_count;
  const auto preview = walk.engine().targets().preview;
  ASSERT_TRUE(walk.engine().change(Tuning(slower_and_wider())));
  walk.run(2 * from().tick);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT((walk.engine().targets().preview[i].position - preview[i].position).norm(), 2e-3);
  }
  while (walk.engine().targets().step_count < landed + 2) {
    EXPECT_TRUE(walk.engine().change_waits());
    EXPECT_EQ(walk.engine().parameters().t_ss, from().t_ss);
    EXPECT_NEAR(walk.engine().targets().t_ss, from().t_ss, 0.01);
    walk.run(from().tick);
  }
  walk.run(from().t_ds + 2 * from().tick);
  EXPECT_FALSE(walk.engine().change_waits());
  EXPECT_NEAR(walk.engine().targets().t_ss, 0.55, 0.01);
}

TEST_P(ParameterChange, OfAWalkThatStopsOrBeginsAnewMeanwhile) {
  const Tuning tuning(slower_and_wider());
  for (double phase = 0.0; phase < cycle(); phase += 5.5 * phase_of_change) {
    for (double later = 0.0; later < cycle(); later += 8.5 * phase_of_change) {
      Walk walk(from());
      walk.engine().walk({0.2, 0.0, 0.0});
      walk.run(from().t_init + cycle() + phase);
      walk.engine().stop();
      walk.run(later);
      ASSERT_TRUE(walk.engine().change(tuning));
      walk.run(0.13);
      walk.engine().walk({0.1, 0.0, 0.0});
      walk.forget();
      walk.run(5.0);
      EXPECT_LT(walk.worst_error(), 0.05) << phase << " + " << later;
      EXPECT_FALSE(walk.engine().change_waits());
      walk.forget();
      walk.run(0.5);
      EXPECT_LT(walk.worst_error(), 2e-3) << phase << " + " << later;
    }
  }
}

TEST(ParameterChangeStanding, AtRestItIsMadeAtOnceAndOnTheWayToRestAtItsEnd) {
  Walk walk;
  walk.run(2.0);
  ASSERT_TRUE(walk.engine().change(Tuning(slower_and_wider())));
  walk.run(0.001);
  EXPECT_FALSE(walk.engine().change_waits());
  EXPECT_EQ(walk.engine().parameters().stance_width, 0.26);

  Walk moved(quick(), {0.03, -0.02});
  moved.run(0.1);
  Parameters quicker = quick();
  quicker.t_init = 0.3;
  ASSERT_TRUE(moved.engine().change(Tuning(quicker)));
  moved.run(0.1);
  EXPECT_TRUE(moved.engine().change_waits());
  moved.run(1.0);
  EXPECT_FALSE(moved.engine().change_waits());
  EXPECT_LT(moved.worst_velocity_jump(), 9.81 * 0.1 * quicker.tick);
}

TEST(ParameterChangeStanding, AListIsWalkedAsItWasAccepted) {
  Walk walk;
  walk.run(0.1);
  const std::array<Footstep, 3> steps{Footstep{{0.25, -0.1}, 0.0, Side::right},
                                      Footstep{{0.5, 0.1}, 0.0, Side::left},
                                      Footstep{{0.5, -0.1}, 0.0, Side::right}};
  ASSERT_EQ(walk.engine().follow(steps), WalkingEngine::StepListError::none);
  walk.run(0.7);
  Parameters shorter = quick();
  shorter.max_step_length = 0.2;
  ASSERT_TRUE(walk.engine().change(Tuning(shorter)));
  walk.run(4.0);
  EXPECT_FALSE(walk.engine().change_waits());
  EXPECT_LT((walk.measurement().feet[0].position.head<2>() - Vec2(0.5, 0.1)).norm(), 0.01);
  std::size_t refused = 0;
  const std::array<Footstep, 2> again{Footstep{{0.6, -0.1}, 0.0, Side::right},
                                      Footstep{{0.9, 0.1}, 0.0, Side::left}};
  EXPECT_EQ(walk.engine().follow(again, &refused), WalkingEngine::StepListError::out_of_reach);
  EXPECT_EQ(refused, 1U);
}

TEST(ParameterChangeRefused, OfAnotherBodyOrWithParametersThatAreNotValid) {
  Walk walk;
  Parameters heavier = quick();
  heavier.mass = 40.0;
  EXPECT_FALSE(walk.engine().change(Tuning(heavier)));
  EXPECT_FALSE(walk.engine().change_waits());
  Parameters bad = quick();
  bad.t_ss = -1.0;
  EXPECT_THROW(Tuning{bad}, std::invalid_argument);
}

TEST(ParameterChangeStrategies, StayAsTheyAre) {
  Walk walk;
  walk.run(2.0);
  walk.engine().set_strategies({true, false, false, true});
  ASSERT_TRUE(walk.engine().change(Tuning(slower_and_wider())));
  walk.run(0.001);
  EXPECT_EQ(walk.engine().parameters().strategies, (Strategies{true, false, false, true}));
}

}  // namespace
}  // namespace stagger::engine
