// The whole engine on a point mass that this test integrates on its own.
#include <gtest/gtest.h>

#include <vector>

#include "tests/engine/point_mass_walk.h"

namespace stagger::engine {
namespace {

using testing::quick;
using testing::Walk;

TEST(WalkingEngine, StandsStill) {
  Walk walk;
  walk.run(5.0);
  EXPECT_LT(walk.com().norm(), 1e-9);
  EXPECT_EQ(walk.engine().targets().state, WalkingState::idle);
}

TEST(WalkingEngine, StepsInPlaceOnItsReference) {
  Walk walk;
  walk.engine().walk({});
  walk.run(20.0);
  EXPECT_EQ(walk.engine().targets().step_count, 38U);
  EXPECT_LT(walk.worst_error(), 2e-3);
  EXPECT_NEAR(walk.com().x(), 0.0, 1e-9);
}

TEST(WalkingEngine, AFootThatLandsOnItsEdgeDoesNotLiftTheGround) {
  Walk walk;
  // A foot's middle comes down a centimetre in the tenth of a second after the edge.
  PerFoot<int> ticks{1000, 1000};
  walk.set_sensors([&](Measurement& seen) {
    for (std::size_t i = 0; i < 2; ++i) {
      double& height = seen.feet[i].position.z();
      ticks[i] = height > 0.0 ? 0 : ticks[i] + 1;
      if (ticks[i] > 0) height += 0.01 * std::max(0.0, 1.0 - 0.01 * ticks[i]);
    }
  });
  walk.engine().walk({});
  walk.run(20.0);
  EXPECT_EQ(walk.engine().targets().step_count, 38U);  // none of them late
  EXPECT_EQ(walk.engine().targets().ground_slope, Vec2::Zero());
}

TEST(WalkingEngine, ReferenceVelocityNeverJumps) {
  Walk walk;
  walk.engine().walk({});
  walk.run(10.0);
  // w^2 times the longest lever arm (0.2 m) times a tick, with room to spare for the replanning.
  EXPECT_LT(walk.worst_velocity_jump(), 9.81 * 0.2 * 0.001 * 2.0);
}

TEST(WalkingEngine, WalksAtTheCommandedVelocity) {
  Walk walk;
  walk.engine().walk({0.3, 0.0, 0.0});
  walk.run(3.0);
  const double start = walk.com().x();
  walk.run(10.0);
  EXPECT_NEAR(walk.com().x() - start, 3.0, 0.02);
}

TEST(WalkingEngine, StopsInTheMiddleOfItsFeet) {
  for (const double when : {3.0, 3.13, 3.27, 3.41}) {
    Walk walk;
    walk.engine().walk({0.2, 0.0, 0.0});
    walk.run(when);
    walk.engine().stop();
    walk.run(5.0);
    EXPECT_EQ(walk.engine().targets().state, WalkingState::idle) << when;
    const auto& feet = walk.measurement().feet;
    const Vec2 middle = 0.5 * (feet[0].position + feet[1].position).head<2>();
    EXPECT_LT((walk.com() - middle).norm(), 2e-3) << when;
    EXPECT_LT(walk.velocity().norm(), 2e-3) << when;
    EXPECT_NEAR((feet[0].position - feet[1].position).norm(), 0.2, 1e-6) << when;
  }
}

TEST(WalkingEngine, StartsAgainAfterAStop) {
  Walk walk;
  walk.engine().walk({});
  walk.run(2.0);
  walk.engine().stop();
  walk.run(0.3);
  walk.engine().walk({});
  const auto steps = walk.engine().targets().step_count;
  walk.run(5.0);
  EXPECT_GT(walk.engine().targets().step_count, steps + 6);
  EXPECT_LT((walk.dcm() - walk.engine().targets().dcm_reference).norm(), 5e-3);
}

TEST(WalkingEngine, TakesPushesInEveryDirectionByStepping) {
  for (int direction = 0; direction < 360; direction += 45) {
    for (const double when : {4.0, 4.17, 4.33}) {
      Walk walk;
      walk.engine().walk({});
      walk.run(when);
      const double angle = direction * M_PI / 180.0;
      walk.push(0.2 * Vec2(std::cos(angle), std::sin(angle)));
      walk.run(5.0);
      walk.forget();
      walk.run(2.0);
      EXPECT_LT(walk.worst_error(), 5e-3) << direction << " deg at " << when << " s";
    }
  }
}

TEST(WalkingEngine, WithoutStepsThatPushIsTooMuch) {
  Walk walk;
  Strategies ankle_only;
  ankle_only.step = ankle_only.time = false;
  walk.engine().set_strategies(ankle_only);
  walk.engine().walk({});
  walk.run(4.17);
  walk.push({0.4, 0.0});
  walk.run(3.0);
  EXPECT_GT(walk.worst_error(), 1.0);
}

TEST(WalkingEngine, TheSwingFootGoesToTheAdjustedStep) {
  Parameters parameters = quick();
  parameters.ankle_share = 0.0;  // leave all of the catch to the step
  Walk walk(parameters);
  walk.engine().walk({});
  walk.run(4.05);
  while (walk.engine().targets().state != WalkingState::single_support) walk.run(0.001);
  walk.run(0.1);
  walk.push({0.2, 0.0});
  while (walk.engine().targets().state == WalkingState::single_support) walk.run(0.001);
  const Side landed = other(walk.engine().targets().support_side);
  // 0.2 / omega, magnified until touchdown and by the transfer: about 0.18 m.
  EXPECT_GT(walk.measurement().feet[index(landed)].position.x(), 0.12);
}

/// Where the swing foot lands, forward from its stance foot, after a push 0.1 s into the step.
double landing_after(double push, double ankle_share) {
  Parameters parameters = quick();
  parameters.ankle_share = ankle_share;
  Walk walk(parameters);
  walk.engine().walk({});
  walk.run(4.05);
  while (walk.engine().targets().state != WalkingState::single_support) walk.run(0.001);
  walk.run(0.1);
  walk.push({push, 0.0});
  while (walk.engine().targets().state == WalkingState::single_support) walk.run(0.001);
  const auto& feet = walk.measurement().feet;
  const Side stance = walk.engine().targets().support_side;
  return feet[index(other(stance))].position.x() - feet[index(stance)].position.x();
}

TEST(WalkingEngine, TheAnkleDoesItsShareOfTheCatch) {
  // 0.05 m/s need the ZMP 2 cm ahead until touchdown: less than 0.3 of the sole, so no step
  // changes.
  EXPECT_NEAR(landing_after(0.05, 0.3), 0.0, 1e-9);
  EXPECT_GT(landing_after(0.05, 0.0), 0.02);
  // A harder push takes both: a shorter step than without the ankle, and a step all the same.
  EXPECT_GT(landing_after(0.3, 0.3), 0.1);
  EXPECT_LT(landing_after(0.3, 0.3), landing_after(0.3, 0.0) - 0.03);
}

TEST(WalkingEngine, StepsSoonerWhenTheLongestStepIsTooShort) {
  Parameters parameters = quick();
  parameters.max_step_length = 0.3;
  Strategies without_time;
  without_time.time = false;
  const auto survives = [&](const Strategies& strategies) {
    Walk walk(parameters);
    walk.engine().set_strategies(strategies);
    walk.engine().walk({});
    walk.run(4.05);
    walk.run(0.1);  // 0.05 s into a single support
    walk.push({0.75, 0.0});
    walk.run(4.0);
    return walk.dcm().norm() < 10.0;
  };
  EXPECT_FALSE(survives(without_time));
  EXPECT_TRUE(survives({}));
}

TEST(WalkingEngine, StepsSoonerRatherThanBeyondTheTimesReach) {
  struct Landing {
    double length;
    double time_change;
  };
  const auto push = [](double time_reach) {
    Parameters parameters = quick();
    parameters.max_step_length = 0.3;
    parameters.time_reach = time_reach;
    parameters.time_constant = 0.01;
    parameters.ankle_share = 0.0;  // all of the catch is the step's
    Walk walk(parameters);
    walk.engine().walk({});
    walk.run(4.05);
    while (walk.engine().targets().state != WalkingState::single_support) walk.run(0.001);
    const Side stance = walk.engine().targets().support_side;
    const double from = walk.measurement().feet[index(stance)].position.x();
    walk.run(0.1);
    walk.push({0.2, 0.0});  // wants 0.18 m of the 0.3 m
    while (walk.engine().targets().state == WalkingState::single_support) walk.run(0.001);
    return Landing{walk.measurement().feet[index(other(stance))].position.x() - from,
                   walk.engine().targets().t_ss - parameters.t_ss};
  };
  const Landing whole = push(1.0);
  EXPECT_NEAR(whole.time_change, 0.0, 2e-3);
  const Landing most = push(0.4);
  EXPECT_LT(most.time_change, -0.02);
  EXPECT_LT(most.length, whole.length - 0.02);
  // Beyond this share still, where the time has done what it may.
  EXPECT_GT(most.length, 0.1);
}

/// A step in place, pushed so long after lift-off to the side of its swing foot.
struct PushedStep {
  double t_ss;        ///< that it took [s]
  double width;       ///< of the feet, once it has landed [m]
  double most_speed;  ///< of the swing foot over the ground [m/s]
  bool stays_up;
};

PushedStep pushed_step(const Parameters& parameters, double after, double push) {
  Walk walk(parameters);
  walk.engine().walk({});
  walk.run(4.05);
  while (walk.engine().targets().state != WalkingState::single_support) walk.run(0.001);
  walk.run(after);
  const Side swing = other(walk.engine().targets().support_side);
  walk.push({0.0, swing == Side::left ? push : -push});
  PushedStep step{};
  while (walk.engine().targets().state == WalkingState::single_support) {
    step.t_ss = walk.engine().targets().t_ss;
    const auto& foot = walk.engine().targets().feet[index(swing)];
    step.most_speed = std::max(step.most_speed, foot.velocity.head<2>().norm());
    walk.run(0.001);
  }
  const auto& feet = walk.measurement().feet;
  step.width = std::abs(feet[0].position.y() - feet[1].position.y());
  walk.run(4.0);
  step.stays_up = walk.dcm().norm() < 10.0;
  return step;
}

TEST(WalkingEngine, TakesALateStepAnewWhenItWouldMiss) {
  Parameters parameters = quick();
  parameters.swing_acceleration = 100.0;
  const double late = parameters.t_ss - 0.5 * parameters.step_freeze;
  const PushedStep missing = pushed_step(parameters, late, 0.6);
  EXPECT_NEAR(missing.t_ss, parameters.t_ss, 1e-9);
  EXPECT_NEAR(missing.width, parameters.stance_width, 1e-3);

  parameters.step_anew = 0.1;
  const PushedStep anew = pushed_step(parameters, late, 0.6);
  EXPECT_GT(anew.t_ss, parameters.t_ss + 0.05);
  EXPECT_LT(anew.t_ss, parameters.t_ss + parameters.time_limit + 1e-9);
  EXPECT_GT(anew.width, parameters.stance_width + 0.15);
  EXPECT_TRUE(anew.stays_up);

  // A small miss is left to the next step, and with one of the strategies off all of them.
  EXPECT_NEAR(pushed_step(parameters, late, 0.1).width, parameters.stance_width, 1e-3);
  for (bool Strategies::*strategy : {&Strategies::step, &Strategies::time}) {
    Parameters without = parameters;
    without.strategies.*strategy = false;
    EXPECT_NEAR(pushed_step(without, late, 0.6).t_ss, parameters.t_ss, 1e-9);
  }
}

TEST(WalkingEngine, GivesAnAdjustedStepTheTimeThatItsFootNeeds) {
  Parameters parameters = quick();
  const double middle = 0.5 * parameters.t_ss;
  const PushedStep fast = pushed_step(parameters, middle, 0.9);
  parameters.swing_acceleration = 15.0;
  const PushedStep slow = pushed_step(parameters, middle, 0.9);
  EXPECT_GT(slow.t_ss, fast.t_ss + 0.03);
  EXPECT_LT(slow.most_speed, fast.most_speed);
}

/// A step in place that lands so much deeper than the one before it, pushed when its place is
/// frozen already: how far apart the feet are then [m].
double width_of_late_step(const Parameters& parameters, double depth) {
  Walk walk(parameters);
  walk.engine().walk({});
  walk.run(4.05);
  while (walk.engine().targets().state != WalkingState::single_support) walk.run(0.001);
  const Side swing = other(walk.engine().targets().support_side);
  walk.set_sensors([&](Measurement& seen) {
    for (std::size_t i = 0; i < 2; ++i) {
      seen.foot_load[i] = seen.feet[i].position.z() <= -depth ? 150.0 : 0.0;
    }
  });
  walk.run(parameters.t_ss - 0.02);
  walk.push({0.0, swing == Side::left ? 0.1 : -0.1});
  while (walk.engine().targets().state == WalkingState::single_support) walk.run(0.001);
  EXPECT_NEAR(walk.measurement().feet[index(swing)].position.z(), -depth, 1e-3);
  return std::abs(walk.measurement().feet[0].position.y() -
                  walk.measurement().feet[1].position.y());
}

TEST(WalkingEngine, ALateFootGoesAfterTheDcm) {
  Parameters parameters = quick();
  // A push that is left to the next step, as long as this one comes in time.
  EXPECT_NEAR(width_of_late_step(parameters, 0.0), parameters.stance_width, 1e-3);
  EXPECT_GT(width_of_late_step(parameters, 0.01), parameters.stance_width + 0.03);
  EXPECT_GT(width_of_late_step(parameters, 0.02), width_of_late_step(parameters, 0.01) + 0.01);
  parameters.landing_rate = 0.0;
  EXPECT_NEAR(width_of_late_step(parameters, 0.02), parameters.stance_width, 1e-3);
  parameters.landing_rate = 60.0;
  parameters.strategies.step = false;
  EXPECT_NEAR(width_of_late_step(parameters, 0.02), parameters.stance_width, 1e-3);
}

TEST(WalkingEngine, AFootThatIsHeldWaitsUntilItIsLetGo) {
  const Parameters parameters = quick();
  Walk walk;
  walk.engine().walk({0.3, 0.0, 0.0});
  walk.run(4.05);
  while (walk.engine().targets().state != WalkingState::single_support) walk.run(0.001);
  const std::size_t foot = index(other(walk.engine().targets().support_side));
  walk.run(0.08);
  const FootPose caught = walk.measurement().feet[foot];
  double load = 1.1 * parameters.hold_load;  // its normal part is less than a landing's
  ASSERT_LT(load, parameters.contact_load);
  walk.set_sensors([&](Measurement& seen) {
    if (load == 0.0) return;
    seen.feet[foot].position.head<2>() = caught.position.head<2>();
    seen.foot_load[foot] = load;
  });
  double height = 0.0;
  for (int i = 0; i < 80; ++i) {
    walk.run(0.001);
    const FootTarget& target = walk.engine().targets().feet[foot];
    // Nothing pulls it on, but up it goes.
    EXPECT_LT((target.position - caught.position).head<2>().norm(), 1e-3) << i;
    EXPECT_GT(target.position.z(), height) << i;
    height = target.position.z();
  }
  load = 0.0;
  Vec2 goal = Vec2::Zero();
  while (walk.engine().targets().state == WalkingState::single_support) {
    goal = walk.engine().targets().adjusted_step.position;
    walk.run(0.001);
  }
  const Vec2 landed = walk.measurement().feet[foot].position.head<2>();
  EXPECT_LT((landed - goal).norm(), 1e-3);
  EXPECT_GT(landed.x() - caught.position.x(), 0.2);
}

/// Steps that it takes within five seconds after the left foot has slipped that far at rest.
std::uint64_t steps_after_slip(Walk& walk, const Vec2& way) {
  walk.run(2.0);
  EXPECT_EQ(walk.engine().targets().state, WalkingState::idle);
  const std::uint64_t before = walk.engine().targets().step_count;
  walk.slip(Side::left, way);
  walk.run(5.0);
  EXPECT_EQ(walk.engine().targets().state, WalkingState::idle);
  return walk.engine().targets().step_count - before;
}

TEST(WalkingEngine, AStanceThatHasGoneOutOfShapeIsSteppedRight) {
  Walk walk;
  walk.engine().walk({});
  walk.run(2.0);
  walk.engine().stop();
  walk.run(2.0);
  EXPECT_EQ(steps_after_slip(walk, {0.03, 0.0}), 0U);  // of no matter
  EXPECT_GT(steps_after_slip(walk, {0.05, 0.02}), 0U);
  const Vec3 apart = walk.measurement().feet[0].position - walk.measurement().feet[1].position;
  EXPECT_NEAR(apart.x(), 0.0, 0.02);
  EXPECT_NEAR(apart.y(), quick().stance_width, 0.02);
  EXPECT_EQ(steps_after_slip(walk, {0.0, 0.0}), 0U);

  Strategies no_steps;
  no_steps.step = false;
  walk.engine().set_strategies(no_steps);
  EXPECT_EQ(steps_after_slip(walk, {0.08, 0.0}), 0U);
}

TEST(WalkingEngine, AStanceThatWasAskedForIsKept) {
  Walk first;  // as it was started
  EXPECT_EQ(steps_after_slip(first, {0.08, 0.0}), 0U);
  Walk listed;
  listed.run(0.1);
  const std::array<Footstep, 2> steps{Footstep{{0.1, -0.1}, 0.0, Side::right},
                                      Footstep{{0.2, 0.12}, 0.0, Side::left}};
  ASSERT_EQ(listed.engine().follow(steps), WalkingEngine::StepListError::none);
  listed.run(4.0);
  listed.engine().stop();
  EXPECT_EQ(steps_after_slip(listed, {0.0, 0.0}), 0U);
}

TEST(WalkingEngine, KeepsTheNominalTimeWhileNothingIsWrong) {
  Walk walk;
  walk.engine().walk({0.2, 0.0, 0.0});
  for (int i = 0; i < 5000; ++i) {
    walk.run(0.001);
    if (walk.engine().targets().state == WalkingState::single_support) {
      ASSERT_NEAR(walk.engine().targets().t_ss, quick().t_ss, 1e-9) << i;
    }
  }
}

TEST(WalkingEngine, FollowsAListOfStepsAndStandsOnTheLastTwo) {
  Walk walk;
  walk.run(0.1);
  const std::array<Footstep, 4> steps{
      Footstep{{0.2, -0.1}, 0.0, Side::right}, Footstep{{0.4, 0.12}, 0.0, Side::left},
      Footstep{{0.6, -0.08}, 0.0, Side::right}, Footstep{{0.6, 0.12}, 0.0, Side::left}};
  ASSERT_EQ(walk.engine().follow(steps), WalkingEngine::StepListError::none);
  walk.run(6.0);
  EXPECT_EQ(walk.engine().targets().state, WalkingState::idle);
  EXPECT_EQ(walk.engine().targets().step_count, 4U);
  const auto& feet = walk.measurement().feet;
  EXPECT_LT((feet[0].position.head<2>() - steps[3].position).norm(), 0.02);
  EXPECT_LT((feet[1].position.head<2>() - steps[2].position).norm(), 0.02);
  EXPECT_LT((walk.com() - Vec2(0.6, 0.02)).norm(), 0.02);
}

TEST(WalkingEngine, RefusesListsThatItCannotWalk) {
  using Error = WalkingEngine::StepListError;
  Walk walk;
  walk.run(0.1);
  const Footstep right{{0.2, -0.1}, 0.0, Side::right};
  const Footstep far{{5.0, 0.1}, 0.0, Side::left};
  EXPECT_EQ(walk.engine().follow(std::array{right, right}), Error::wrong_side);
  EXPECT_EQ(walk.engine().follow(std::array{right, far}), Error::out_of_reach);
  const Footstep turned{{0.0, -0.2}, -0.7, Side::right};
  EXPECT_EQ(walk.engine().follow(std::array{turned}), Error::turns_too_far);
  const Footstep toe_to_toe{{0.0, 0.0}, 0.5, Side::right};
  EXPECT_EQ(walk.engine().follow(std::array{toe_to_toe}), Error::soles_too_near);
  const Footstep nowhere{{std::nan(""), -0.1}, 0.0, Side::right};
  EXPECT_EQ(walk.engine().follow(std::array{nowhere}), Error::out_of_reach);
  EXPECT_EQ(walk.engine().follow(std::vector<Footstep>(65, right)), Error::too_long);
  walk.engine().walk({});
  walk.run(1.0);
  EXPECT_EQ(walk.engine().follow(std::array{right}), Error::walking);
}

TEST(WalkingEngine, AdjustedStepsKeepTheFeetApartInATurnToo) {
  Parameters parameters = quick();
  parameters.foot_half_length = 0.12;  // long feet: toes meet at the least width
  for (int direction = 0; direction < 360; direction += 30) {
    Walk walk(parameters);
    walk.engine().walk({0.1, 0.0, 0.6});
    walk.run(4.0);
    const double angle = direction * M_PI / 180.0;
    walk.push(0.3 * Vec2(std::cos(angle), std::sin(angle)));
    for (int i = 0; i < 2000; ++i) {
      walk.run(0.001);
      const WalkingTargets& t = walk.engine().targets();
      if (t.state != WalkingState::single_support) continue;
      const FootTarget& foot = t.feet[index(t.support_side)];
      const Footstep stance{foot.position.head<2>(), foot.yaw, t.support_side};
      ASSERT_EQ(check_step(stance, t.adjusted_step, walk.engine().reach(), parameters),
                StepFault::none)
          << direction << " deg, tick " << i;
    }
  }
}

TEST(WalkingEngine, TellsTheCommandThatItWalks) {
  Walk walk;
  walk.engine().walk({0.2, 0.05, 0.1});
  EXPECT_EQ(walk.engine().command().vx, 0.2);
  walk.engine().walk({9.0, 0.0, 0.0});
  EXPECT_NEAR(walk.engine().command().vx, quick().max_step_length / (0.15 + quick().t_ds), 1e-6);
  walk.engine().stop();
  EXPECT_EQ(walk.engine().command().vx, 0.0);
}

}  // namespace
}  // namespace stagger::engine
