#include "sim/plant/bullet_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "sim/plant/motor_limits.h"
#include "sim/robot/rigid_body.h"
#include "sim/robot/robot.h"
#include "tests/sim/random_robot.h"

namespace stagger::sim {
namespace {

constexpr double weight = 30.0 * 9.81;  // [N]

class BulletWorldTest : public ::testing::Test {
 protected:
  /// High above the ground, at rest.
  RobotState flying() const {
    RobotState state = standing_;
    state.base_position.z() += 50.0;
    return state;
  }
  /// Gravity's share of the joint torques in a symmetric stance, and a spring back to it.
  Eigen::VectorXd holding_torque(const RobotState& state) {
    body_.update(state);
    Eigen::VectorXd torque = body_.bias().tail(12);
    Matrix6X jacobian(6, body_.nv());
    for (const Side side : {Side::left, Side::right}) {
      const int foot = robot_->foot_body(side);
      body_.jacobian(foot, body_.pose(foot) * robot_->sole_in_body(side).translation(), jacobian);
      torque -= 0.5 * weight * jacobian.row(2).tail(12).transpose();
    }
    return torque - 400.0 * (state.q - standing_.q) - 4.0 * state.qd;
  }
  /// What is left of M nudot + bias - S^T tau - sum J^T f over one step: joint rows are the forces
  /// of limits, the first six must vanish.
  Eigen::VectorXd unexplained(const RobotState& before, const BulletWorld& world,
                              std::span<const AppliedForce> pushes,
                              std::span<const Vec3> push_points) {
    const double dt = world.parameters().dt;
    const RobotState& after = world.state();
    // Bullet steps the velocity of the base's centre of mass.
    const Vec3& com = robot_->model.bodies[0].com;
    const Vec3 arm = before.base_orientation * com;
    const Vec3 arm_after = after.base_orientation * com;
    const Vec3& omega = before.base_angular_velocity;
    const Vec3 alpha = (after.base_angular_velocity - omega) / dt;
    const Vec3 com_before = before.base_velocity + omega.cross(arm);
    const Vec3 com_after = after.base_velocity + after.base_angular_velocity.cross(arm_after);
    Eigen::VectorXd nudot(18);
    nudot << (com_after - com_before) / dt - alpha.cross(arm) - omega.cross(omega.cross(arm)),
        alpha, (after.qd - before.qd) / dt;

    body_.update(before, world.parameters().gravity);
    Eigen::VectorXd rest = body_.mass_matrix() * nudot + body_.bias();
    rest.tail(12) -= world.applied_torque();
    Matrix6X jacobian(6, 18);
    for (const BulletWorld::Contact& contact : world.contacts()) {
      body_.jacobian(contact.body, contact.point, jacobian);
      rest -= jacobian.topRows<3>().transpose() * contact.force;
      if (contact.with_ground()) continue;
      body_.jacobian(contact.other, contact.point, jacobian);
      rest += jacobian.topRows<3>().transpose() * contact.force;
    }
    for (std::size_t i = 0; i < pushes.size(); ++i) {
      const int pushed = robot_->model.links.at(pushes[i].link).body;
      body_.jacobian(pushed, push_points[i], jacobian);
      rest -= jacobian.topRows<3>().transpose() * pushes[i].force;
    }
    return rest;
  }
  Vec3 ground_force(const BulletWorld& world) const {
    Vec3 sum = Vec3::Zero();
    for (const BulletWorld::Contact& contact : world.contacts()) {
      if (contact.with_ground()) sum += contact.force;
    }
    return sum;
  }
  /// Greatest moment that forces between bodies may seem to leave over: Bullet lets a force and its
  /// opposite act where each surface is, up to two millimetres apart [N m].
  double gap_moment(const BulletWorld& world) const {
    double sum = 0.0;
    for (const BulletWorld::Contact& contact : world.contacts()) {
      if (!contact.with_ground()) sum += 2e-3 * contact.force.norm();
    }
    return sum;
  }
  /// Presses the legs together; all else but the limp feet stays about where it is.
  Eigen::VectorXd legs_together(const RobotState& state) const {
    Eigen::VectorXd result = no_torque_;
    for (const std::string leg : {"left", "right"}) {
      for (const char* joint : {"_hip_yaw", "_hip_pitch", "_knee"}) {
        const int i = robot_->model.joint_index(leg + joint);
        result[i] = -400.0 * (state.q[i] - standing_.q[i]) - 5.0 * state.qd[i];
      }
      const int roll = robot_->model.joint_index(leg + "_hip_roll");
      result[roll] = (leg == "left" ? -20.0 : 20.0) - 5.0 * state.qd[roll];
    }
    return result;
  }
  /// Distance between the axes of the two shanks' cylinders [m].
  double shank_distance(const RobotState& state) const {
    const auto poses = body_poses(robot_->model, state);
    std::array<std::array<Vec3, 2>, 2> ends;
    for (const Side side : {Side::left, Side::right}) {
      const char* link = side == Side::left ? "left_shank" : "right_shank";
      const int body = robot_->model.links.at(link).body;
      const Shape& cylinder = robot_->model.bodies[body].shapes.at(0);
      const Eigen::Isometry3d pose = poses[body] * cylinder.pose;
      const Vec3 half(0.0, 0.0, 0.5 * cylinder.size.y());
      ends[engine::index(side)] = {pose * half, pose * Vec3(-half)};
    }
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 100; ++i) {
      const Vec3 a = ends[0][0] + 0.01 * i * (ends[0][1] - ends[0][0]);
      const Vec3 b = ends[1][0] + 0.01 * i * (ends[1][1] - ends[1][0]);
      least = std::min(least, (a - b).norm());
    }
    return least;
  }

  std::shared_ptr<const Robot> robot_ = load_robot("robots/kasaei");
  RobotState standing_ = nominal_state(*robot_);
  RigidBody body_{robot_->model};
  Eigen::VectorXd no_torque_ = Eigen::VectorXd::Zero(12);
};

TEST_F(BulletWorldTest, StartsInTheGivenState) {
  Random random(1);
  const RobotState start = random.state(robot_->model);
  const BulletWorld world(robot_->model, start, {});
  EXPECT_EQ(world.state().base_position, start.base_position);
  EXPECT_EQ(world.state().qd, start.qd);
  EXPECT_TRUE(world.contacts().empty());
}

TEST_F(BulletWorldTest, FallsFreely) {
  RobotState start = flying();
  start.base_velocity = Vec3(1.0, -0.5, 0.0);
  BulletWorld world(robot_->model, start, {});
  for (int i = 0; i < 1000; ++i) world.step(no_torque_, {});
  // Velocities first, then positions: z falls g (n^2 + n) / 2 dt^2.
  const Vec3 fallen(1.0, -0.5, -9.81 * 1000.0 * 1001.0 / 2.0 * 1e-6);
  EXPECT_NEAR((world.state().base_position - start.base_position - fallen).norm(), 0.0, 1e-9);
  EXPECT_NEAR((world.state().q - start.q).norm(), 0.0, 1e-9);
  EXPECT_TRUE(world.contacts().empty());
}

TEST_F(BulletWorldTest, StateReadsBackWhatBulletMoved) {
  // Away from every force, one step must carry the base's own origin along by its velocity,
  // although Bullet only knows the centre of mass and the principal axes.
  Random random(2);
  RobotModel model = random.model(4);
  RobotState start = random.state(model);
  start.qd.setZero();
  constexpr double dt = 1e-6;
  BulletWorld world(model, start, {.dt = dt, .gravity = 0.0});
  world.step(Eigen::VectorXd::Zero(3), {});
  const RobotState expected = moved(start, Eigen::VectorXd::Zero(9), dt);
  EXPECT_NEAR((world.state().base_position - expected.base_position).norm(), 0.0, 1e-9);
  EXPECT_NEAR(world.state().base_orientation.angularDistance(expected.base_orientation), 0.0, 1e-9);
}

TEST_F(BulletWorldTest, PushActsAtItsPoint) {
  for (const char* link : {"torso", "pelvis", "left_shank", "right_foot"}) {
    RobotState before = flying();
    BulletWorld world(robot_->model, before, {});
    const AppliedForce push{link, Vec3(0.05, 0.02, -0.1), Vec3(100.0, -200.0, 50.0)};
    const LinkPlace& place = robot_->model.links.at(link);
    for (int i = 0; i < 10; ++i) {
      const Vec3 point = world.application_point(push);
      const auto poses = body_poses(robot_->model, before);
      EXPECT_NEAR((point - poses[place.body] * place.pose * *push.point).norm(), 0.0, 1e-12);
      world.step(no_torque_, {&push, 1});
      const Eigen::VectorXd rest = unexplained(before, world, {&push, 1}, {&point, 1});
      // The limp foot flies about and reaches its ankle's limits: those are internal forces.
      EXPECT_NEAR(rest.head<6>().norm(), 0.0, 1e-6) << link << " tick " << i;
      before = world.state();
    }
  }
}

TEST_F(BulletWorldTest, PushDeliversItsImpulse) {
  BulletWorld world(robot_->model, flying(), {.gravity = 0.0});
  const AppliedForce push{"torso", std::nullopt, Vec3(100.0, -200.0, 50.0)};
  for (int i = 0; i < 10; ++i) world.step(no_torque_, {&push, 1});
  body_.update(world.state());
  const Vec3 impulse = 0.010 * push.force;
  // What is lost belongs to the integrator: joints that move within a tick cost 2nd order momentum.
  EXPECT_NEAR((30.0 * body_.com_velocity() - impulse).norm(), 0.0, 0.005 * impulse.norm());
}

TEST_F(BulletWorldTest, PushWithoutPointActsAtTheLinksOwnCentreOfMass) {
  const BulletWorld world(robot_->model, standing_, {});
  const Vec3 point = world.application_point({"torso", std::nullopt, Vec3::UnitX()});
  // Not that of pelvis and torso together, which would be 0.07 m lower.
  EXPECT_NEAR(point.z(), standing_.base_position.z() + 0.1 + 0.2933217, 1e-12);
}

TEST_F(BulletWorldTest, TheGroundCarriesTheWeight) {
  BulletWorld world(robot_->model, standing_, {});
  for (int i = 0; i < 1000; ++i) world.step(holding_torque(world.state()), {});
  EXPECT_NEAR((ground_force(world) - Vec3(0.0, 0.0, weight)).norm(), 0.0, 0.1);
  EXPECT_EQ(world.contacts().size(), 8u);
  EXPECT_TRUE(world.touches_ground(robot_->foot_body(Side::left)));
  EXPECT_TRUE(world.touches_ground(robot_->foot_body(Side::right)));
  EXPECT_FALSE(world.touches_ground(0));
  EXPECT_NEAR((world.state().base_position - standing_.base_position).norm(), 0.0, 1e-3);
  for (const BulletWorld::Contact& contact : world.contacts()) {
    EXPECT_NEAR(contact.point.z(), 0.0, 1e-5);
    EXPECT_NEAR(std::abs(contact.point.x()), 0.075, 1e-3);
    EXPECT_GT(contact.force.z(), 0.0);
    EXPECT_LE(contact.force.head<2>().norm(), 0.8 * contact.force.z() * (1.0 + 1e-9));
  }
}

TEST_F(BulletWorldTest, ContactForcesExplainTheMotion) {
  // A sliding robot that collapses: forces and their moments on the whole body, tick by tick.
  RobotState before = standing_;
  before.base_velocity = Vec3(1.0, 0.4, 0.0);
  BulletWorld world(robot_->model, before, {});
  double greatest = 0.0;
  for (int i = 0; i < 800; ++i) {
    world.step(no_torque_, {});
    const double force = ground_force(world).norm();
    const Eigen::VectorXd rest = unexplained(before, world, {}, {});
    ASSERT_NEAR(rest.head<3>().norm(), 0.0, 1e-3 + 1e-6 * force) << "tick " << i;
    ASSERT_NEAR(rest.segment<3>(3).norm(), 0.0, 1e-3 + 1e-6 * force + gap_moment(world))
        << "tick " << i;
    greatest = std::max(greatest, force);
    before = world.state();
  }
  EXPECT_GT(greatest, 1000.0);  // it did hit the ground
}

TEST_F(BulletWorldTest, SoleCornersLieFlatFarFromTheOrigin) {
  RobotState start = standing_;
  const Vec3 far(300.0, -400.0, 0.0);
  start.base_position += far;
  BulletWorld world(robot_->model, start, {});
  BulletWorld home(robot_->model, standing_, {});
  for (int i = 0; i < 300; ++i) {
    world.step(holding_torque(world.state()), {});
    home.step(holding_torque(home.state()), {});
  }
  EXPECT_EQ(world.contacts().size(), 8u);
  EXPECT_NEAR((world.state().base_position - far - home.state().base_position).norm(), 0.0, 1e-6);
}

TEST_F(BulletWorldTest, FrictionLimitsSliding) {
  for (const double friction : {0.3, 0.8}) {
    RobotState start = standing_;
    start.base_velocity = Vec3(2.0, 0.0, 0.0);
    TerrainParameters terrain;
    terrain.friction = friction;
    BulletWorld world(robot_->model, start, {}, Terrain(terrain));
    world.step(holding_torque(start), {});
    const Vec3 force = ground_force(world);
    EXPECT_GT(force.z(), 1.0);
    EXPECT_NEAR(force.x(), -friction * force.z(), 0.02 * force.z());  // against the motion
  }
}

TEST_F(BulletWorldTest, TheTorsoOnTheGroundIsSeen) {
  BulletWorld world(robot_->model, standing_, {});
  AppliedForce push{"torso", std::nullopt, Vec3(200.0, 0.0, 0.0)};
  bool torso_down = false;
  for (int i = 0; i < 3000 && !torso_down; ++i) {
    world.step(no_torque_, {&push, i < 100 ? 1u : 0u});
    torso_down = world.touches_ground(0);
  }
  EXPECT_TRUE(torso_down);
}

TEST_F(BulletWorldTest, LegsThatArePressedTogetherStopAtEachOther) {
  constexpr double shank_diameter = 0.09;
  for (const bool self_collision : {true, false}) {
    BulletWorld world(robot_->model, flying(), {.gravity = 0.0, .self_collision = self_collision});
    double least = 1.0;
    RobotState before = world.state();
    std::size_t touching = 0;
    for (int i = 0; i < 1000; ++i) {
      world.step(legs_together(world.state()), {});
      least = std::min(least, shank_distance(world.state()));
      touching += world.contacts().empty() ? 0 : 1;
      for (const BulletWorld::Contact& contact : world.contacts()) {
        ASSERT_FALSE(contact.with_ground());
        ASSERT_FALSE(world.touches_ground(contact.body));
      }
      // Whatever the legs do to each other, the whole robot is not accelerated by it.
      const Eigen::VectorXd rest = unexplained(before, world, {}, {});
      ASSERT_NEAR(rest.head<3>().norm(), 0.0, 1e-3) << "tick " << i;
      ASSERT_NEAR(rest.segment<3>(3).norm(), 0.0, 1e-3 + gap_moment(world)) << "tick " << i;
      before = world.state();
    }
    if (self_collision) {
      EXPECT_GT(least, shank_diameter - 0.002);
      EXPECT_LT(least, shank_diameter + 0.002);
      EXPECT_GT(touching, 500u);
    } else {
      EXPECT_LT(least, 0.5 * shank_diameter);
      EXPECT_EQ(touching, 0u);
    }
  }
}

TEST_F(BulletWorldTest, BodiesThatOverlapAtTheStartLetEachOtherThrough) {
  RobotState crossed = flying();
  crossed.q[robot_->model.joint_index("left_hip_roll")] = -0.3;
  crossed.q[robot_->model.joint_index("right_hip_roll")] = 0.3;
  BulletWorld world(robot_->model, crossed, {.gravity = 0.0});
  for (int i = 0; i < 100; ++i) world.step(no_torque_, {});
  EXPECT_LT((world.state().q - crossed.q).norm(), 1e-9);
}

TEST_F(BulletWorldTest, SelfCollisionCostsNoBitWhileNothingTouches) {
  StateHash hashes[2];
  for (const bool self_collision : {true, false}) {
    BulletWorld world(robot_->model, standing_, {.self_collision = self_collision});
    const AppliedForce push{"torso", std::nullopt, Vec3(10.0, 20.0, 0.0)};
    for (int i = 0; i < 500; ++i) {
      world.step(holding_torque(world.state()), {&push, i < 50 ? 1u : 0u});
      world.mix_state(hashes[self_collision ? 1 : 0]);
    }
  }
  EXPECT_EQ(hashes[0].value(), hashes[1].value());
}

TEST_F(BulletWorldTest, JointLimitsHold) {
  BulletWorld world(robot_->model, flying(), {.gravity = 0.0});
  Eigen::VectorXd torque = no_torque_;
  const int knee = robot_->model.joint_index("left_knee");
  const int yaw = robot_->model.joint_index("right_hip_yaw");  // its body has no geometry
  torque[knee] = -20.0;
  torque[yaw] = 20.0;
  double least = 0.0;
  double most = 0.0;
  for (int i = 0; i < 2000; ++i) {
    world.step(torque, {});
    least = std::min(least, world.state().q[knee]);
    most = std::max(most, world.state().q[yaw]);
  }
  EXPECT_NEAR(world.state().q[knee], 0.0, 0.01);
  EXPECT_NEAR(world.state().q[yaw], 0.8, 0.01);
  EXPECT_GT(least, -0.05);
  EXPECT_LT(most, 0.85);
}

TEST_F(BulletWorldTest, UnlimitedJointsTurnFreely) {
  RobotModel model = robot_->model;
  const int yaw = model.joint_index("left_hip_yaw");
  model.bodies[yaw + 1].lower = -std::numeric_limits<double>::infinity();
  model.bodies[yaw + 1].upper = std::numeric_limits<double>::infinity();
  RobotState start = flying();
  start.qd[yaw] = 5.0;
  BulletWorld world(model, start, {.gravity = 0.0});
  for (int i = 0; i < 2000; ++i) world.step(no_torque_, {});
  EXPECT_GT(world.state().q[yaw], 2.0);  // the limit was 1.0
}

TEST_F(BulletWorldTest, TorqueIsCutToTheEffortLimit) {
  const RobotState start = flying();
  const int knee = robot_->model.joint_index("left_knee");
  Eigen::VectorXd limit = no_torque_;
  Eigen::VectorXd beyond = no_torque_;
  limit[knee] = 200.0;
  beyond[knee] = 5000.0;
  BulletWorld first(robot_->model, start, {});
  BulletWorld second(robot_->model, start, {});
  first.step(limit, {});
  second.step(beyond, {});
  EXPECT_EQ(second.applied_torque()[knee], 200.0);
  EXPECT_EQ(first.state().qd, second.state().qd);
}

TEST(MotorLimits, FadeTowardsTheSpeedLimitOnlyForDrivingTorque) {
  Body body;
  body.effort = 100.0;
  body.velocity = 10.0;
  EXPECT_EQ(available_torque(body, 0.0).upper, 100.0);
  EXPECT_EQ(available_torque(body, 8.0).upper, 100.0);
  EXPECT_NEAR(available_torque(body, 9.0).upper, 50.0, 1e-9);
  EXPECT_EQ(available_torque(body, 12.0).upper, 0.0);
  EXPECT_EQ(available_torque(body, 12.0).lower, -100.0);
  EXPECT_EQ(available_torque(body, -12.0).lower, 0.0);
  EXPECT_EQ(available_torque(body, -12.0).upper, 100.0);
  body.velocity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(available_torque(body, 1e6).upper, 100.0);
}

TEST_F(BulletWorldTest, RepeatsToTheBitInOneProcessAndInTwo) {
  const auto hash_of_a_fall = [&] {
    BulletWorld world(robot_->model, standing_, {});
    AppliedForce push{"torso", std::nullopt, Vec3(80.0, 60.0, 0.0)};
    StateHash hash;
    for (int i = 0; i < 700; ++i) {
      const bool holding = i < 300;
      world.step(holding ? holding_torque(world.state()) : no_torque_,
                 {&push, i >= 200 && i < 300 ? 1u : 0u});
      world.mix_state(hash);
    }
    return to_hex(hash.value());
  };
  const std::string hash = hash_of_a_fall();
  if (std::getenv("STAGGER_HASH_CHILD")) {
    std::printf("hash=%s\n", hash.c_str());
    return;
  }
  EXPECT_EQ(hash, hash_of_a_fall());

  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command =
      "STAGGER_HASH_CHILD=1 GTEST_OUTPUT= '" + self +
      "' --gtest_filter=BulletWorldTest.RepeatsToTheBitInOneProcessAndInTwo";
  std::unique_ptr<FILE, int (*)(FILE*)> child(popen(command.c_str(), "r"), pclose);
  ASSERT_TRUE(child);
  std::string output;
  std::array<char, 256> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), child.get())) output += buffer.data();
  EXPECT_THAT(output, ::testing::HasSubstr("hash=" + hash));
}

}  // namespace
}  // namespace stagger::sim
