#include "engine/swing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stagger::engine {
namespace {

const FootPose lift_off{Vec3(0.0, 0.1, 0.0), 0.0};
const FootPose landing{Vec3(0.3, 0.12, 0.02), 0.2};

SwingTrajectory swing() {
  SwingTrajectory trajectory;
  trajectory.start(lift_off, landing, 0.4, 0.05);
  return trajectory;
}

TEST(Swing, StartsAndEndsAtRestOnTheGround) {
  const SwingTrajectory trajectory = swing();
  const FootTarget start = trajectory.at(0.0);
  const FootTarget end = trajectory.at(0.4);
  EXPECT_LT((start.position - lift_off.position).norm(), 1e-12);
  EXPECT_LT((end.position - landing.position).norm(), 1e-12);
  EXPECT_NEAR(end.yaw, 0.2, 1e-12);
  for (const FootTarget& foot : {start, end}) EXPECT_LT(foot.velocity.norm(), 1e-9);
  EXPECT_LT(start.acceleration.head<2>().norm(), 1e-9);
  EXPECT_LT(end.acceleration.norm(), 1e-9);
}

TEST(Swing, ComesUpBeforeItGoesForward) {
  const SwingTrajectory trajectory = swing();
  EXPECT_GT(trajectory.at(0.0).acceleration.z(), 5.0);
  const Vec3 way = trajectory.at(0.04).position - lift_off.position;
  EXPECT_GT(way.z(), 3.0 * way.head<2>().norm());
}

TEST(Swing, ClearsTheGroundByTheSwingHeight) {
  SwingTrajectory trajectory;
  trajectory.start(lift_off, {Vec3(0.3, 0.1, 0.0), 0.0}, 0.4, 0.05);
  double highest = 0.0;
  for (int i = 0; i <= 400; ++i) highest = std::max(highest, trajectory.at(i * 0.001).position.z());
  EXPECT_NEAR(highest, 0.05, 1e-6);
}

TEST(Swing, DerivativesAreOfThePosition) {
  const SwingTrajectory trajectory = swing();
  const double h = 1e-6;
  for (const double t : {0.05, 0.2, 0.33}) {
    const FootTarget now = trajectory.at(t);
    const FootTarget before = trajectory.at(t - h);
    const FootTarget after = trajectory.at(t + h);
    EXPECT_LT((now.velocity - (after.position - before.position) / (2 * h)).norm(), 1e-6);
    EXPECT_LT((now.acceleration - (after.velocity - before.velocity) / (2 * h)).norm(), 1e-5);
    EXPECT_NEAR(now.yaw_velocity, (after.yaw - before.yaw) / (2 * h), 1e-6);
  }
}

TEST(Swing, RetargetKeepsPositionVelocityAndAcceleration) {
  SwingTrajectory trajectory = swing();
  const FootTarget before = trajectory.at(0.15);
  const FootPose elsewhere{Vec3(0.5, 0.0, 0.02), -0.1};
  trajectory.retarget(elsewhere, 0.15, 0.4);
  const FootTarget after = trajectory.at(0.15);
  EXPECT_LT((after.position - before.position).head<2>().norm(), 1e-12);
  EXPECT_LT((after.velocity - before.velocity).head<2>().norm(), 1e-10);
  EXPECT_LT((after.acceleration - before.acceleration).head<2>().norm(), 1e-8);
  EXPECT_LT((trajectory.at(0.4).position - elsewhere.position).norm(), 1e-12);
}

TEST(Swing, FeelsForTheGroundWhenItIsLate) {
  SwingTrajectory trajectory = swing();
  trajectory.set_landing(0.2, 4.0);
  const FootTarget late = trajectory.at(0.45);
  EXPECT_NEAR(late.position.z(), 0.02 - 0.2 * 0.05 - 0.5 * 4.0 * 0.05 * 0.05, 1e-12);
  EXPECT_NEAR(late.velocity.z(), -0.2 - 4.0 * 0.05, 1e-12);
  EXPECT_EQ(late.position.head<2>(), landing.position.head<2>());
}

TEST(Swing, ALateFootGoesAfterAPlace) {
  SwingTrajectory trajectory = swing();
  const Vec2 way(-0.02, 0.06);
  const Vec2 place = landing.position.head<2>() + way;
  for (int i = 0; i < 100; ++i) {
    const Vec2 before = trajectory.at(0.401).position.head<2>();
    trajectory.go_after(place, 60.0, 0.001);
    const FootTarget foot = trajectory.at(0.401);
    EXPECT_LT((foot.position.head<2>() - before - 0.001 * foot.velocity.head<2>()).norm(), 2e-4);
    // It nears the place, and never goes beyond.
    EXPECT_GE((place - foot.position.head<2>()).dot(way), 0.0) << i;
  }
  // Critically damped: (1 + r t) e^{-r t} of the way is left.
  const double left = (place - trajectory.at(0.5).position.head<2>()).norm();
  EXPECT_NEAR(left / way.norm(), 7.0 * std::exp(-6.0), 1e-9);

  const Vec2 there = trajectory.at(0.5).position.head<2>();
  trajectory.start(lift_off, landing, 0.4, 0.05);
  trajectory.go_after(there, 0.0, 0.001);
  EXPECT_EQ(trajectory.at(0.5).position.head<2>(), landing.position.head<2>());
}

TEST(Swing, AHeldFootGoesOnFromRestAndComesUpAsBefore) {
  SwingTrajectory trajectory = swing();
  const FootTarget before = trajectory.at(0.15);
  const FootPose held{Vec3(0.03, 0.1, 0.04), 0.5};
  trajectory.hold(held, 0.15);
  const FootTarget after = trajectory.at(0.15);
  EXPECT_LT((after.position - held.position).head<2>().norm(), 1e-12);
  EXPECT_LT(after.velocity.head<2>().norm(), 1e-12);
  EXPECT_NEAR(after.yaw, before.yaw, 1e-12);
  EXPECT_NEAR(after.position.z(), before.position.z(), 1e-12);
  EXPECT_NEAR(after.velocity.z(), before.velocity.z(), 1e-10);
  EXPECT_LT((trajectory.at(0.4).position - landing.position).norm(), 1e-12);
  EXPECT_NEAR(trajectory.at(0.4).yaw, landing.yaw, 1e-12);
}

TEST(Swing, LiftsOnceMoreWithoutAJump) {
  SwingTrajectory trajectory = swing();
  const FootTarget before = trajectory.at(0.37);
  EXPECT_LT(before.position.z(), 0.025);
  const FootPose elsewhere{Vec3(0.5, -0.1, 0.02), 0.2};
  trajectory.retarget(elsewhere, 0.37, 0.55);
  trajectory.lift(0.05);
  const FootTarget after = trajectory.at(0.37);
  EXPECT_LT((after.position - before.position).norm(), 1e-12);
  EXPECT_LT((after.velocity - before.velocity).norm(), 1e-10);
  EXPECT_LT((after.acceleration - before.acceleration).norm(), 1e-8);
  double highest = 0.0;
  for (double t = 0.37; t < 0.55; t += 0.001) {
    highest = std::max(highest, trajectory.at(t).position.z());
  }
  // It was on its way down.
  EXPECT_GT(highest, 0.05);
  EXPECT_LT(highest, 0.075);
  EXPECT_LT((trajectory.at(0.55).position - elsewhere.position).norm(), 1e-12);
}

/// The greatest acceleration over the ground from `time` to the landing.
double hardest(const SwingTrajectory& trajectory, double time) {
  double most = 0.0;
  for (double t = time; t <= trajectory.duration(); t += 1e-4) {
    most = std::max(most, trajectory.at(t).acceleration.head<2>().norm());
  }
  return most;
}

TEST(Swing, TheLeastTimeKeepsToTheAcceleration) {
  SwingTrajectory trajectory;
  const double duration = least_time({0.3, 0.0}, Vec2::Zero(), 0.0, 50.0);
  trajectory.start({}, {Vec3(0.3, 0.0, 0.0), 0.0}, duration, 0.05);
  EXPECT_NEAR(hardest(trajectory, 0.0), 50.0, 0.1);

  // From its way to another place: about.
  const double now = 0.5 * duration;
  const FootTarget foot = trajectory.at(now);
  const Vec2 way = Vec2(0.3, -0.3) - foot.position.head<2>();
  double left = duration;
  for (int i = 0; i < 10; ++i) left = least_time(way, foot.velocity.head<2>(), left, 50.0);
  trajectory.retarget({Vec3(0.3, -0.3, 0.0), 0.0}, now, now + left);
  EXPECT_NEAR(hardest(trajectory, now), 50.0, 15.0);
}

}  // namespace
}  // namespace stagger::engine
