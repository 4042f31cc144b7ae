// Starts, stops, new commands and step lists at every phase of the gait, on the point mass.
#include <gtest/gtest.h>

#include "tests/engine/point_mass_walk.h"

namespace stagger::engine {
namespace {

using testing::quick;
using testing::Walk;

constexpr double phase_step = 0.02;  // [s]

Parameters without_double_support() {
  Parameters p = quick();
  p.t_ds = 0.0;
  return p;
}

class GaitChange : public ::testing::TestWithParam<Parameters> {
 protected:
  const Parameters p = GetParam();
  const double cycle = 2.0 * (p.t_ss + p.t_ds);  // [s]
  const std::vector<WalkCommand> commands{
      {}, {0.3, 0.0, 0.0}, {0.0, 0.15, 0.0}, {0.2, 0.1, 0.3}, {-0.2, 0.0, -0.4}};

  /// Walks in the steady gait, `phase` into its cycle.
  Walk walking(const WalkCommand& command, double phase) const {
    Walk walk(p);
    walk.engine().walk(command);
    walk.run(p.t_init + cycle + phase);
    walk.forget();
    return walk;
  }

  static void expect_stands_side_by_side(const Walk& walk, const char* what, double phase) {
    const auto& feet = walk.measurement().feet;
    const Vec2 apart = rotated((feet[0].position - feet[1].position).head<2>(), -feet[0].yaw);
    EXPECT_EQ(walk.engine().targets().state, WalkingState::idle) << what << " at " << phase;
    EXPECT_LT((apart - Vec2(0.0, quick().stance_width)).norm(), 1e-3) << what << " at " << phase;
    EXPECT_NEAR(feet[0].yaw, feet[1].yaw, 1e-3) << what << " at " << phase;
    EXPECT_LT((walk.com() - walk.middle()).norm(), 1e-3) << what << " at " << phase;
    EXPECT_LT(walk.velocity().norm(), 1e-3) << what << " at " << phase;
  }
};

INSTANTIATE_TEST_SUITE_P(Gaits, GaitChange, ::testing::Values(quick(), without_double_support()),
                         [](const auto& test) {
                           return test.param.t_ds > 0.0 ? "Quick" : "NoDoubleSupport";
                         });

TEST_P(GaitChange, AnyWalkKeepsToItsReferenceAndItsReferenceDoesNotJump) {
  for (const WalkCommand& command : commands) {
    Walk walk = walking(command, 0.0);
    walk.run(5.0);
    EXPECT_LT(walk.worst_error(), 2e-3) << command.vx << ", " << command.vy;
    // w^2 times the longest lever arm times a tick, with room to spare for the replanning.
    EXPECT_LT(walk.worst_velocity_jump(), 9.81 * 0.25 * p.tick * 2.0) << command.vx;
  }
}

TEST_P(GaitChange, AStopAtAnyPhaseEndsSideBySideWithTheComInTheMiddle) {
  for (const WalkCommand& command : commands) {
    for (double phase = 0.0; phase < cycle; phase += phase_step) {
      Walk walk = walking(command, phase);
      walk.engine().stop();
      walk.run(4.0);
      expect_stands_side_by_side(walk, "stop", phase);
      EXPECT_LT(walk.worst_error(), 0.025) << phase;
    }
  }
}

TEST_P(GaitChange, AStopOfAPushedWalkTakesTheStepsItNeedsToEndSideBySide) {
  for (double phase = 0.0; phase < cycle; phase += 5 * phase_step) {
    Walk walk = walking({0.2, 0.0, 0.0}, phase);
    walk.engine().stop();
    walk.run(0.1);
    walk.push({0.05, 0.05});
    walk.run(5.0);
    expect_stands_side_by_side(walk, "push", phase);
  }
}

TEST_P(GaitChange, AStopDuringTheWeightShiftStandsAtOnceWithoutAJump) {
  for (double time = 0.0; time < p.t_init; time += phase_step) {
    Walk walk(p);
    walk.engine().walk({0.2, 0.0, 0.0});
    walk.run(time);
    walk.engine().stop();
    walk.run(2 * p.tick);
    EXPECT_EQ(walk.engine().targets().state, WalkingState::idle) << time;
    walk.run(3.0);
    expect_stands_side_by_side(walk, "stop", time);
    EXPECT_EQ(walk.engine().targets().step_count, 0U);
    EXPECT_LT(walk.worst_error(), 2e-3) << time;
    EXPECT_LT(walk.worst_velocity_jump(), 9.81 * 0.15 * p.tick * 2.0) << time;
  }
}

TEST_P(GaitChange, AStartAgainWhileStoppingWorksAtAnyPhase) {
  for (double phase = 0.0; phase < cycle; phase += 5 * phase_step) {
    for (double later = 0.0; later < cycle + p.t_init + 0.4; later += 3.5 * phase_step) {
      Walk walk = walking({0.2, 0.05, 0.0}, phase);
      walk.engine().stop();
      walk.run(later);
      walk.forget();
      walk.engine().walk({0.2, 0.05, 0.0});
      const std::uint64_t steps = walk.engine().targets().step_count;
      walk.run(3.0);
      EXPECT_LT(walk.worst_error(), 0.04) << phase << " + " << later;
      EXPECT_GE(walk.engine().targets().step_count, steps + 3) << phase << " + " << later;
      walk.forget();
      walk.run(0.5);
      EXPECT_LT(walk.worst_error(), 2e-3) << phase << " + " << later;
    }
  }
}

TEST_P(GaitChange, ANewCommandAtAnyPhaseKeepsTheErrorSmall) {
  // With the steps adjusted and without: the ankle has to do then.
  for (const bool step : {true, false}) {
    for (const WalkCommand& command : commands) {
      const std::array<WalkCommand, 3> changes{
          WalkCommand{-command.vx, -command.vy, -command.wz},
          WalkCommand{command.vx, command.vy, command.wz + 0.4}, WalkCommand{}};
      for (double phase = 0.0; phase < cycle; phase += 4.5 * phase_step) {
        for (const WalkCommand& change : changes) {
          // Standing on one foot after another, the ankle alone has no room for that.
          if (!step && p.t_ds == 0.0) continue;
          Walk walk = walking(command, phase);
          Strategies strategies;
          strategies.step = strategies.time = step;
          walk.engine().set_strategies(strategies);
          walk.engine().walk(change);
          walk.run(3.0);
          EXPECT_LT(walk.worst_error(), 0.03) << command.vx << " -> " << change.vx << ' ' << phase;
          walk.forget();
          walk.run(0.5);
          EXPECT_LT(walk.worst_error(), 2e-3) << command.vx << " -> " << change.vx << ' ' << phase;
        }
      }
    }
  }
}

TEST_P(GaitChange, ManyCommandsNeverLetTheFeetTouch) {
  Walk walk = walking({}, 0.0);
  std::uint64_t steps = walk.engine().targets().step_count;
  for (int i = 0; i < 300; ++i) {
    // Whole-number noise: -3 to 3 in each part.
    const auto part = [i](int prime) { return (i * prime) % 7 - 3; };
    walk.engine().walk({0.15 * part(3), 0.05 * part(5), 0.2 * part(11)});
    if (i % 20 == 19) walk.engine().stop();
    for (int n = 0; n < 7; ++n) {
      walk.run(0.02);
      const WalkingTargets& t = walk.engine().targets();
      if (t.step_count == steps) continue;
      steps = t.step_count;
      const auto& feet = walk.measurement().feet;
      const Footstep left{feet[0].position.head<2>(), feet[0].yaw, Side::left};
      const Footstep right{feet[1].position.head<2>(), feet[1].yaw, Side::right};
      const Footstep& stance = t.support_side == Side::left ? left : right;
      EXPECT_EQ(
          check_step(stance, t.support_side == Side::left ? right : left, walk.engine().reach(), p),
          StepFault::none)
          << i;
    }
  }
  EXPECT_GT(steps, 60U);
  EXPECT_LT((walk.dcm() - walk.engine().targets().dcm_reference).norm(), 0.03);
}

TEST(GaitStart, FromRestTheReferenceStartsWithoutAJump) {
  for (const Vec2& com : {Vec2(0.0, 0.0), Vec2(0.03, 0.02), Vec2(-0.03, -0.05)}) {
    const Parameters p = quick();
    Walk walk(p, com);
    walk.engine().walk({});
    walk.run(p.tick);
    const WalkingTargets& t = walk.engine().targets();
    ASSERT_EQ(t.state, WalkingState::initialize);
    const double allowed = 9.81 * (t.com_reference - t.zmp_reference).norm() * p.tick + 1e-9;
    EXPECT_LT(t.com_velocity_reference.norm(), allowed) << com.transpose();
    walk.run(5.0);
    EXPECT_LT(walk.worst_error(), 5e-3) << com.transpose();
  }
}

TEST(GaitStart, OffTheMiddleTheComIsTakenThereSmoothlyAndAWalkCanBeginAnyTime) {
  const Parameters p = quick();
  for (const double wait : {0.05, 0.3, 0.6, 1.0, 8.0}) {
    Walk walk(p, {0.03, -0.04});
    walk.run(wait);
    EXPECT_LT(walk.worst_velocity_jump(), 9.81 * 0.1 * p.tick) << wait;
    const Vec2 before = walk.engine().targets().com_velocity_reference;
    walk.engine().walk({});
    walk.run(p.tick);
    const WalkingTargets& t = walk.engine().targets();
    ASSERT_EQ(t.state, WalkingState::initialize);
    const double allowed = 9.81 * (t.com_reference - t.zmp_reference).norm() * p.tick + 1e-9;
    EXPECT_LT((t.com_velocity_reference - before).norm(), allowed) << wait;
  }
  Walk walk(p, {0.03, -0.04});
  walk.run(3.0);
  EXPECT_LT(walk.com().norm(), 1e-3);
}

TEST(GaitStart, AListOfStepsCanBeFollowedFromAnyStance) {
  using Error = WalkingEngine::StepListError;
  Walk walk;
  walk.run(0.1);
  const auto follow = [&](const std::vector<Footstep>& steps) {
    walk.forget();
    EXPECT_EQ(walk.engine().follow(steps), Error::none);
    walk.run(0.5 * static_cast<double>(steps.size()) + 2.5);
    EXPECT_EQ(walk.engine().targets().state, WalkingState::idle);
    EXPECT_LT(walk.worst_error(), 2e-3);
    EXPECT_LT((walk.com() - walk.middle()).norm(), 2e-3);
    for (std::size_t i = steps.size() < 2 ? 0 : steps.size() - 2; i < steps.size(); ++i) {
      const FootPose& foot = walk.measurement().feet[index(steps[i].side)];
      EXPECT_LT((foot.position.head<2>() - steps[i].position).norm(), 0.01);
      EXPECT_NEAR(foot.yaw, steps[i].yaw, 1e-3);
    }
  };
  follow({{{0.3, -0.15}, -0.2, Side::right}});  // one step, feet apart and turned
  follow({{{0.1, 0.2}, 0.1, Side::left}, {{0.35, -0.1}, 0.0, Side::right}});
  follow({{{0.3, -0.25}, -0.3, Side::right}, {{0.2, 0.0}, -0.1, Side::left}});
  follow({{{0.0, 0.15}, 0.0, Side::left},
          {{-0.1, -0.1}, 0.0, Side::right},
          {{-0.1, 0.1}, 0.0, Side::left}});
}

TEST(GaitStart, ACommandDuringAListTakesOverFromTheSteps) {
  for (double phase = 0.0; phase < 2.4; phase += 2 * phase_step) {
    Walk walk;
    const std::array<Footstep, 4> steps{
        Footstep{{0.2, -0.1}, 0.0, Side::right}, Footstep{{0.4, 0.12}, 0.0, Side::left},
        Footstep{{0.6, -0.08}, 0.0, Side::right}, Footstep{{0.6, 0.12}, 0.0, Side::left}};
    walk.engine().follow(steps);
    walk.run(0.1 + phase);
    walk.forget();
    walk.engine().walk({0.2, 0.0, 0.0});
    walk.run(4.0);
    EXPECT_LT(walk.worst_error(), 0.04) << phase;
    walk.engine().stop();
    walk.run(4.0);
    EXPECT_EQ(walk.engine().targets().state, WalkingState::idle) << phase;
  }
}

TEST(GaitSpeed, ATurningWalkFollowsItsArc) {
  for (const WalkCommand& command :
       {WalkCommand{0.25, 0.0, 0.4}, WalkCommand{0.2, 0.0, -0.5}, WalkCommand{0.1, 0.1, 0.3}}) {
    Walk walk;
    walk.engine().walk(command);
    walk.run(3.6);
    // Over whole cycles, so that the sway drops out.
    const auto middle = [&] { return walk.middle(); };
    const double heading = walk.engine().targets().heading;
    std::vector<Vec2> places;
    for (int i = 0; i < 12; ++i) {
      walk.run(1.0);  // two steps
      places.push_back(middle());
    }
    const double turned = walk.engine().targets().heading - heading;
    EXPECT_NEAR(turned, 12.0 * command.wz, 0.02 * std::abs(12.0 * command.wz));
    // Chords of the circle that a body at this twist goes on.
    const double speed = std::hypot(command.vx, command.vy);
    const double chord = 2.0 * speed / std::abs(command.wz) * std::sin(0.5 * std::abs(command.wz));
    for (std::size_t i = 1; i < places.size(); ++i) {
      EXPECT_NEAR((places[i] - places[i - 1]).norm(), chord, 0.02 * chord) << i;
    }
  }
}

}  // namespace
}  // namespace stagger::engine
