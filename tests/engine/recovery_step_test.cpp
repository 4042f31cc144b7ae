// A robot that stands and is pushed over takes steps, and stands again.
#include <gtest/gtest.h>

#include <random>

#include "engine/capturability.h"
#include "tests/engine/point_mass_walk.h"

namespace stagger::engine {
namespace {

using testing::quick;
using testing::Walk;

/// The robot of the full body: it reaches 0.7 m forward.
Parameters robot() {
  Parameters p = quick();
  p.max_step_length = 0.7;
  return p;
}

Vec2 towards(int degrees) {
  const double angle = degrees * M_PI / 180.0;
  return {std::cos(angle), std::sin(angle)};
}

/// At rest in the middle of feet that stand side by side.
bool rests(const Walk& walk) {
  const auto& feet = walk.measurement().feet;
  const Vec2 apart = (feet[0].position - feet[1].position).head<2>();
  const WalkingTargets& t = walk.engine().targets();
  return t.state == WalkingState::idle && !t.recovering &&
         (walk.com() - walk.middle()).norm() < 2e-3 && walk.velocity().norm() < 2e-3 &&
         (rotated(apart, -feet[0].yaw) - Vec2(0.0, 0.2)).norm() < 0.02;
}

bool survives(const Parameters& parameters, const Vec2& velocity) {
  Walk walk(parameters);
  walk.run(0.5);
  walk.push(velocity);
  walk.run(10.0);
  return rests(walk);
}

/// What no controller exceeds, whichever foot steps: change of the CoM's velocity [m/s].
double ceiling(const Parameters& p, const Vec2& direction) {
  StepAbility ability = step_ability(p, ReachRegion(p), true);
  ability.sooner = p.t_ss - p.least_t_ss;
  const ConvexSet left = viable_dcm(ability, p.least_t_ss, p.t_ss + ability.later);
  const Vec2 foot(0.0, 0.5 * p.stance_width);
  const double most = std::max(ray_exit(shifted(left, foot), direction),
                               ray_exit(shifted(mirrored(left), -foot), direction));
  return most * ability.omega;
}

class RecoverySteps : public ::testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Directions, RecoverySteps, ::testing::Range(0, 360, 15));

TEST_P(RecoverySteps, SavePushesOfALadder) {
  const Vec2 direction = towards(GetParam());
  // Never only for some: 0.85 m/s sideways, where least can be done, 1.3 m/s ahead and back.
  const double most = 0.85 + 0.45 * direction.x() * direction.x();
  for (double push = 0.05; push <= most; push += 0.1) {
    EXPECT_TRUE(survives(robot(), push * direction)) << push << " m/s";
  }
}

TEST_P(RecoverySteps, SaveNothingThatCannotBeSaved) {
  const Vec2 direction = towards(GetParam());
  const double most = ceiling(robot(), direction);
  EXPECT_GT(most, 1.1);
  EXPECT_FALSE(survives(robot(), 1.03 * most * direction));
}

TEST_P(RecoverySteps, SaveThePaperRobotToo) {
  Parameters slow;  // 0.8 s + 0.2 s a step
  slow.measurement_noise = 1e-8;
  EXPECT_TRUE(survives(slow, 0.7 * towards(GetParam())));
}

TEST_P(RecoverySteps, SaveWithNominalTimesWhatTheseCan) {
  Parameters p = robot();
  p.strategies.time = false;
  Walk walk(p);
  walk.run(0.5);
  const Vec2 direction = towards(GetParam());
  walk.push((0.46 + 0.1 * std::abs(direction.x())) * direction);
  for (int i = 0; i < 2000; ++i) {
    walk.run(0.001);
    if (walk.engine().targets().state != WalkingState::single_support) continue;
    ASSERT_NEAR(walk.engine().targets().t_ss, p.t_ss, 1e-9);
  }
  EXPECT_GT(walk.engine().targets().step_count, 0U);
  walk.run(10.0);
  EXPECT_TRUE(rests(walk));
}

TEST(RecoveryStep, BeginsAtOnceAndIsTold) {
  Walk walk(robot());
  walk.run(0.5);
  walk.push({0.6, 0.0});
  EXPECT_FALSE(walk.engine().targets().recovering);
  walk.run(0.001);
  const WalkingTargets& t = walk.engine().targets();
  EXPECT_EQ(t.state, WalkingState::single_support);
  EXPECT_TRUE(t.recovering);
  EXPECT_FALSE(t.feet[index(other(t.support_side))].in_contact);
  EXPECT_GT(t.adjusted_step.position.x(), 0.3);
  walk.run(6.0);
  EXPECT_FALSE(t.recovering);
  EXPECT_EQ(t.step_count, 2U);
}

TEST(RecoveryStep, MayBeShorterThanItsPlaceIsFrozen) {
  Parameters p = robot();
  p.step_freeze = 0.35;  // more than the 0.32 s of a recovery step
  EXPECT_TRUE(survives(p, {0.5, 0.0}));
}

TEST(RecoveryStep, DoesNotBeginWhileTheAnkleCanHoldIt) {
  for (int direction = 0; direction < 360; direction += 15) {
    const Vec2 u = towards(direction);
    // The edge of the soles along u, less half a millimetre.
    const double edge =
        std::min(0.075 / std::max(std::abs(u.x()), 1e-9), 0.1375 / std::max(std::abs(u.y()), 1e-9));
    for (const double by : {-5e-4, 2e-3}) {
      Walk walk(robot());
      walk.run(0.5);
      walk.push((edge + by) * std::sqrt(9.81) * u);
      walk.run(10.0);
      EXPECT_EQ(walk.engine().targets().step_count > 0, by > 0.0) << direction << ", " << by;
      EXPECT_TRUE(rests(walk)) << direction << ", " << by;
    }
  }
}

TEST(RecoveryStep, WithoutTheStrategyItFalls) {
  Walk walk(robot());
  walk.engine().set_strategies({.step = false});
  walk.run(0.5);
  walk.push({0.4, 0.0});
  walk.run(3.0);
  EXPECT_EQ(walk.engine().targets().state, WalkingState::idle);
  EXPECT_EQ(walk.engine().targets().step_count, 0U);
  EXPECT_GT(walk.dcm().x(), 10.0);
}

TEST(RecoveryStep, TheFootGoesWithoutAJump) {
  for (int direction = 0; direction < 360; direction += 45) {
    Walk walk(robot());
    walk.run(0.5);
    walk.push(0.7 * towards(direction));
    PerFoot<Vec3> last{walk.engine().targets().feet[0].position,
                       walk.engine().targets().feet[1].position};
    for (int i = 0; i < 5000; ++i) {
      walk.run(0.001);
      for (std::size_t foot = 0; foot < 2; ++foot) {
        const Vec3& now = walk.engine().targets().feet[foot].position;
        ASSERT_LT((now - last[foot]).norm(), 0.01) << direction << ", tick " << i;  // 10 m/s
        last[foot] = now;
      }
    }
  }
}

/// Independent noise of CoM and DCM, as the paper has it.
class Noisy {
 public:
  explicit Noisy(double deviation) : noise_(0.0, deviation) {}
  void operator()(Measurement& m) {
    for (int axis = 0; axis < 2; ++axis) {
      const double com = noise_(random_);
      m.com[axis] += com;
      m.com_velocity[axis] += std::sqrt(9.81) * (noise_(random_) - com);
    }
  }

 private:
  std::mt19937 random_{1};
  std::normal_distribution<double> noise_;
};

TEST(RecoveryStep, NoiseNeverTriggersOne) {
  Parameters p = robot();
  p.measurement_noise = 6.25e-4;
  Walk walk(p);
  walk.set_sensors(Noisy(0.025));
  for (int i = 0; i < 60; ++i) {
    walk.run(1.0);
    // What moves the DCM half-way to the edge.
    walk.push(0.5 * 0.075 * std::sqrt(9.81) * towards(45 * i));
  }
  EXPECT_EQ(walk.engine().targets().step_count, 0U);
  EXPECT_EQ(walk.engine().targets().state, WalkingState::idle);
}

TEST(RecoveryStep, WorksInNoise) {
  for (int direction = 0; direction < 360; direction += 45) {
    Parameters p = robot();
    p.measurement_noise = 6.25e-4;
    p.step_margin = 0.03;
    Walk walk(p);
    walk.set_sensors(Noisy(0.025));
    walk.run(0.5);
    walk.push(0.6 * towards(direction));
    walk.run(12.0);
    EXPECT_EQ(walk.engine().targets().state, WalkingState::idle) << direction;
    EXPECT_LT((walk.com() - walk.middle()).norm(), 0.03) << direction;
    EXPECT_GT(walk.engine().targets().step_count, 0U) << direction;
  }
}

TEST(RecoveryStep, ALostMeasurementNeitherTriggersNorPreventsOne) {
  Walk blind(robot());
  blind.run(0.5);
  blind.set_sensors([](Measurement& m) { m.com.setConstant(std::nan("")); });
  blind.push({0.6, 0.0});
  blind.run(0.02);
  EXPECT_EQ(blind.engine().targets().state, WalkingState::idle);
  blind.set_sensors([](Measurement&) {});
  blind.run(10.0);
  EXPECT_GT(blind.engine().targets().step_count, 0U);
  EXPECT_TRUE(rests(blind));

  Walk gaps(robot());
  int i = 0;
  gaps.set_sensors([&](Measurement& m) {
    if (++i % 7 < 3) m.com_velocity.setConstant(1e300);
    if (i % 5 < 2) m.feet[0].position.setConstant(std::nan(""));
  });
  gaps.run(0.5);
  gaps.push({0.6, 0.3});
  gaps.run(10.0);
  EXPECT_TRUE(rests(gaps));
}

TEST(RecoveryStep, PushesOneAfterAnother) {
  for (int direction = 0; direction < 360; direction += 45) {
    for (const double pause : {0.05, 0.3, 0.6, 0.9, 1.5}) {
      Walk walk(robot());
      walk.run(0.5);
      for (int i = 0; i < 4; ++i) {
        walk.push(0.4 * towards(direction + 100 * i));
        walk.run(pause);
      }
      walk.run(12.0);
      EXPECT_TRUE(rests(walk)) << direction << ", every " << pause;
    }
  }
}

TEST(RecoveryStep, AWalkThatIsJustBeginningGoesOn) {
  for (int direction = 0; direction < 360; direction += 45) {
    for (const double when : {0.05, 0.3, 0.55}) {
      Walk walk(robot());
      walk.run(0.5);
      walk.engine().walk({0.2, 0.0, 0.0});
      walk.run(when);
      ASSERT_EQ(walk.engine().targets().state, WalkingState::initialize);
      walk.push(0.6 * towards(direction));
      walk.run(0.002);
      // Over the foot that stands first, the DCM is well held against a push from there.
      EXPECT_EQ(walk.engine().targets().recovering, direction != 270 || when < 0.1)
          << direction << ", " << when;
      walk.run(6.0);
      EXPECT_FALSE(walk.engine().targets().recovering);
      const double from = walk.com().x();
      walk.run(5.0);
      EXPECT_NEAR(walk.com().x() - from, 1.0, 0.1) << direction << ", " << when;
    }
  }
}

TEST(RecoveryStep, ADoubleSupportThatClosesIsLeftToo) {
  for (int direction = 0; direction < 360; direction += 45) {
    Walk walk(robot());
    walk.engine().walk({0.2, 0.0, 0.0});
    walk.run(3.0);
    walk.engine().stop();
    while (!walk.engine().state_machine().closing()) walk.run(0.001);
    walk.run(0.3);
    const std::uint64_t steps = walk.engine().targets().step_count;
    walk.push(0.6 * towards(direction));
    walk.run(10.0);
    EXPECT_TRUE(rests(walk)) << direction;
    EXPECT_GE(walk.engine().targets().step_count, steps + 1) << direction;
  }
}

TEST(RecoveryStep, TakesCommandsOnItsWay) {
  for (const double when : {0.05, 0.2, 0.35, 0.5, 0.9}) {
    Walk walk(robot());
    walk.run(0.5);
    walk.push({0.3, 0.5});
    walk.run(when);
    EXPECT_EQ(walk.engine().follow(std::array{Footstep{{0.0, 0.1}, 0.0, Side::left}}),
              WalkingEngine::StepListError::walking);
    walk.engine().stop();
    walk.run(10.0);
    EXPECT_TRUE(rests(walk)) << when;

    Walk walker(robot());
    walker.run(0.5);
    walker.push({0.3, 0.5});
    walker.run(when);
    walker.engine().walk({0.2, 0.0, 0.0});
    walker.run(6.0);
    const double from = walker.com().x();
    walker.run(5.0);
    EXPECT_NEAR(walker.com().x() - from, 1.0, 0.1) << when;
  }
}

TEST(RecoveryStep, AListGoesOnWhereItsFirstFootIsTheOneThatSteps) {
  const std::array steps{Footstep{{0.2, 0.1}, 0.0, Side::left},
                         Footstep{{0.4, -0.1}, 0.0, Side::right},
                         Footstep{{0.4, 0.1}, 0.0, Side::left}};
  for (const bool same : {true, false}) {
    Walk walk(robot());
    walk.run(0.5);
    ASSERT_EQ(walk.engine().follow(steps), WalkingEngine::StepListError::none);
    walk.run(0.2);
    walk.push({0.0, same ? 0.55 : -0.6});
    walk.run(12.0);
    EXPECT_EQ(walk.engine().targets().state, WalkingState::idle) << same;
    EXPECT_LT((walk.com() - walk.middle()).norm(), 2e-3) << same;
    const double x = walk.middle().x();
    EXPECT_NEAR(x, same ? 0.4 : 0.0, 0.1) << same;
  }
}

TEST(RecoveryStep, FromFeetThatStandTurned) {
  Walk walk(robot());
  walk.engine().walk({0.0, 0.0, 0.5});
  walk.run(6.0);
  walk.engine().stop();
  walk.run(4.0);
  ASSERT_TRUE(rests(walk));
  const std::uint64_t steps = walk.engine().targets().step_count;
  walk.push({0.5, 0.4});
  walk.run(10.0);
  EXPECT_TRUE(rests(walk));
  EXPECT_GT(walk.engine().targets().step_count, steps);
}

}  // namespace
}  // namespace stagger::engine
