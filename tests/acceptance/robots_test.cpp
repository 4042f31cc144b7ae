// Tier 3: every robot that is shipped stands, steps, walks and takes pushes in Bullet. Speeds,
// times and pushes are each robot's own: scaled with its size.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sim/experiment/trial.h"
#include "sim/simulation.h"

namespace stagger::sim {
namespace {

class FullBodyRobots : public ::testing::TestWithParam<const char*> {
 protected:
  double height() const { return robot->description.walk.com_height_m; }
  double time() const { return std::sqrt(height()); }   // [s] where the reference robot takes 1 s
  double speed() const { return std::sqrt(height()); }  // [m/s] likewise

  /// Runs for that long; `command` none: it stands.
  Frame after(double seconds, const std::optional<engine::WalkCommand>& command) {
    SimulationConfig config;
    config.robot = robot;
    config.senses.perfect_state = perfect_state;
    Simulation simulation(config);
    if (command) simulation.walk(*command);
    for (int i = 0; i < std::lround(seconds / Simulation::tick_s); ++i) simulation.step();
    EXPECT_EQ(simulation.fall_reason(), "");
    worst_dcm_error = simulation.worst_dcm_error();
    return simulation.frame();
  }

  std::shared_ptr<const Robot> robot = load_robot(std::string("robots/") + GetParam());
  bool perfect_state = false;
  double worst_dcm_error = 0.0;
};

INSTANTIATE_TEST_SUITE_P(Shipped, FullBodyRobots, ::testing::Values("op3", "g1", "h1_2"));

TEST_P(FullBodyRobots, Stands) {
  const Frame frame = after(5.0, {});
  EXPECT_LT(worst_dcm_error, 0.01 * height());
  EXPECT_NEAR(frame.com.z(), height(), 0.01 * height());
  EXPECT_LT(frame.com_velocity.norm(), 0.01 * speed());
}

TEST_P(FullBodyRobots, StepsInPlaceCloseToItsPlan) {
  after(10.0, engine::WalkCommand());
  EXPECT_LT(worst_dcm_error, 0.04 * height());  // by its sensors, whose noise is no less on op3
  perfect_state = true;
  const Frame frame = after(10.0, engine::WalkCommand());
  EXPECT_GT(frame.step_count, 16 / time());
  EXPECT_LT(worst_dcm_error, 0.02 * height());
  EXPECT_LT(frame.com.head<2>().norm(), 0.1 * height());
  EXPECT_NEAR(frame.com.z(), height(), 0.02 * height());
}

TEST_P(FullBodyRobots, WalksAtTheCommandedVelocity) {
  for (const Vec2& v : {Vec2(0.3, 0.0), Vec2(-0.2, 0.0), Vec2(0.0, 0.15)}) {
    const double seconds = 8.0;
    const Vec2 command = speed() * v;
    const Frame frame = after(seconds, engine::WalkCommand{command.x(), command.y(), 0.0});
    const Vec2 velocity = frame.com.head<2>() / (seconds - time());  // less the start
    EXPECT_LT((velocity - command).norm(), 0.15 * command.norm()) << v.transpose();
  }
}

TEST_P(FullBodyRobots, Turns) {
  const double rate = 0.4;
  const Frame frame = after(6.0, engine::WalkCommand{0.0, 0.0, rate});
  EXPECT_NEAR(frame.feet[0].yaw, rate * 6.0, 0.4);
  EXPECT_LT(frame.com.head<2>().norm(), 0.1 * height());
}

TEST_P(FullBodyRobots, TakesAPushFromEverySide) {
  const double gait = 2.0 * (robot->description.walk.t_ss_s + robot->description.walk.t_ds_s);
  int moment = 0;
  for (int degrees = 0; degrees < 360; degrees += 45) {
    TrialSpec spec;
    spec.robot = GetParam();
    spec.settle_s = 3.0 * time();
    spec.observe_s = 5.0 * time();
    spec.push = PushSpec();
    const double angle = degrees * M_PI / 180.0;
    spec.push->direction = {std::cos(angle), std::sin(angle), 0.0};
    // The change of the CoM's velocity over sqrt(g h).
    const double froude = 0.16;
    spec.push->impulse_ns = froude * std::sqrt(9.81 * height()) * robot->model.mass();
    spec.push->duration_s = 0.01;
    spec.push->trigger = TimeTrigger{spec.settle_s + 0.25 * (moment++ % 4) * gait};
    const TrialResult result = run_trial(spec, robot);
    EXPECT_EQ(result.outcome, TrialOutcome::recovered) << degrees << " deg: " << result.reason;
    // It names no link: it is the torso's.
    EXPECT_NEAR(result.delivered_ns, spec.push->impulse_ns, 1e-9);
  }
}

struct PushedCase {
  const char* robot;
  double froude;  ///< change of the CoM's velocity over sqrt(g h)
  double degrees;
  double phase;  ///< of single support
  double duration_s = 0.01;
  Side leg = Side::left;  ///< that stands
  double vx = 0.0;        ///< of the walk [m/s]
};

/// Of four seeds.
int falls(const PushedCase& pushed) {
  const auto robot = load_robot(std::string("robots/") + pushed.robot);
  const double height = robot->description.walk.com_height_m;
  int fallen = 0;
  for (const std::uint64_t seed : {1, 2, 3, 8}) {
    TrialSpec spec;
    spec.robot = pushed.robot;
    spec.seed = seed;
    spec.walk.vx = pushed.vx;
    spec.push = PushSpec();
    spec.push->direction = horizontal_direction(pushed.degrees);
    spec.push->impulse_ns = pushed.froude * std::sqrt(9.81 * height) * robot->model.mass();
    spec.push->duration_s = pushed.duration_s;
    spec.push->trigger = PhaseTrigger{WalkingState::single_support, pushed.leg, pushed.phase};
    const TrialResult result = run_trial(spec, robot);
    EXPECT_TRUE(result.push_tick) << result.reason;
    if (result.outcome != TrialOutcome::recovered) ++fallen;
  }
  return fallen;
}

TEST(PushedRobots, StepBackNoFasterThanTheirHipsCan) {
  // Planned for more than its hip's torque, h1_2's foot ends far behind its place.
  for (const double phase : {0.1, 0.35, 0.5, 0.55, 0.6}) {
    EXPECT_EQ(falls({"h1_2", 0.245, 180.0, phase}), 0) << phase;
  }
}

TEST(PushedRobots, KeepTheTorsoUpWhileTheyStepBack) {
  // With a torso that weighs by its height alone g1 leans back by 0.8 rad in the second step.
  for (const double phase : {0.1, 0.15, 0.35, 0.6}) {
    EXPECT_EQ(falls({"g1", 0.245, 180.0, phase}), 0) << phase;
  }
}

TEST(PushedRobots, LandALongStepForwardInTime) {
  // With legs nearly straight h1_2's knee whips, and the foot flies 0.1 m beyond its place. And a
  // toe that hangs down is not to be lifted then.
  const PushedCase early{"h1_2", 0.2435, 0.0, 0.1, 0.05, Side::right, 0.3};
  EXPECT_EQ(falls(early), 0);
}

TEST(PushedRobots, TurnAFootBackFromTheEndOfItsAnkle) {
  // Else h1_2's foot, tilted by a long step behind it, lands on its heel in mid-swing.
  int fallen = 0;
  for (const double froude : {0.172, 0.175, 0.177, 0.179})
    fallen += falls({"h1_2", froude, 45.0, 0.35});
  EXPECT_LE(fallen, 1);
}

}  // namespace
}  // namespace stagger::sim
