#include "sim/robot/rigid_body.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <string>
#include <vector>

#include "sim/plant/bullet_world.h"
#include "sim/robot/robot.h"
#include "tests/sim/random_robot.h"
#include "tests/sim/tick.h"

namespace stagger::sim {
namespace {

/// Models to try: a random tree, and the paper's robot.
std::vector<RobotModel> models() {
  return {Random(1).model(9), load_robot("robots/kasaei")->model};
}

/// Kinetic energy body by body, with nothing of RigidBody's algorithms in it.
double kinetic_energy(const RobotModel& model, const RobotState& state) {
  const auto poses = body_poses(model, state);
  std::vector<Vec3> omega(poses.size());
  std::vector<Vec3> velocity(poses.size());
  omega[0] = state.base_angular_velocity;
  velocity[0] = state.base_velocity;
  double energy = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Body& body = model.bodies[i];
    if (i > 0) {
      const auto parent = static_cast<std::size_t>(body.parent);
      const Vec3 arm = poses[i].translation() - poses[parent].translation();
      velocity[i] = velocity[parent] + omega[parent].cross(arm);
      const double qd = state.qd[static_cast<Eigen::Index>(i) - 1];
      omega[i] = omega[parent] + poses[i].linear() * body.axis * qd;
    }
    const Vec3 at_com = velocity[i] + omega[i].cross(poses[i].linear() * body.com);
    const Vec3 local = poses[i].linear().transpose() * omega[i];
    energy += 0.5 * body.mass * at_com.squaredNorm() + 0.5 * local.dot(body.inertia * local);
  }
  return energy;
}

TEST(RigidBody, MassMatrixIsSymmetricAndPositiveDefinite) {
  Random random(2);
  for (const RobotModel& model : models()) {
    RigidBody body(model);
    for (int i = 0; i < 20; ++i) {
      body.update(random.state(model));
      const Eigen::MatrixXd& m = body.mass_matrix();
      EXPECT_EQ(m, m.transpose());
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(m, Eigen::EigenvaluesOnly);
      EXPECT_GT(solver.eigenvalues().minCoeff(), 0.0);
    }
  }
}

TEST(RigidBody, MassMatrixGivesTheKineticEnergy) {
  Random random(3);
  for (const RobotModel& model : models()) {
    RigidBody body(model);
    for (int i = 0; i < 20; ++i) {
      const RobotState state = random.state(model);
      body.update(state);
      const Eigen::VectorXd nu = generalised_velocity(state);
      const double energy = kinetic_energy(model, state);
      EXPECT_NEAR(0.5 * nu.dot(body.mass_matrix() * nu), energy, 1e-12 * energy);
    }
  }
}

TEST(RigidBody, AgreesWithBulletsAccelerations) {
  Random random(4);
  double worst = 0.0;
  for (const RobotModel& model : models()) {
    RigidBody body(model);
    const Vec3& com = model.bodies[0].com;
    // Bullet steps the velocity of the base's CoM, so that is what can be compared exactly.
    const auto bullets_velocity = [&](const RobotState& state) {
      Eigen::VectorXd nu = generalised_velocity(state);
      nu.head<3>() += state.base_angular_velocity.cross(state.base_orientation * com);
      return nu;
    };
    for (int i = 0; i < 50; ++i) {
      RobotState state = random.state(model);
      for (Eigen::Index k = 0; k < state.q.size(); ++k) {  // off the limits
        const Body& carried = model.bodies[static_cast<std::size_t>(k) + 1];
        if (!std::isfinite(carried.lower)) continue;
        state.q[k] = 0.5 * (carried.lower + carried.upper) +
                     0.2 * (carried.upper - carried.lower) * state.q[k] / 2.0;
      }
      const Eigen::VectorXd torque = 50.0 * random.vector(state.q.size());
      BulletWorld world(model, state, {.dt = dt, .gravity = gravity});
      world.step(torque, {});

      body.update(state, gravity);
      Eigen::VectorXd force = -body.bias();
      force.tail(torque.size()) += torque;
      Eigen::VectorXd expected = body.mass_matrix().llt().solve(force);
      const Vec3 arm = state.base_orientation * com;
      const Vec3& omega = state.base_angular_velocity;
      expected.head<3>() += expected.segment<3>(3).cross(arm) + omega.cross(omega.cross(arm));

      const Eigen::VectorXd actual =
          (bullets_velocity(world.state()) - bullets_velocity(state)) / dt;
      worst = std::max(worst, (actual - expected).norm() / expected.norm());
    }
  }
  EXPECT_LT(worst, 1e-11);
}

TEST(RigidBody, JacobiansAreTheDerivativesOfPositions) {
  Random random(5);
  constexpr double h = 1e-5;
  for (const RobotModel& model : models()) {
    RigidBody body(model);
    RigidBody near(model);
    const auto last = static_cast<int>(model.bodies.size()) - 1;
    const RobotState state = random.state(model);
    const Vec3 local(0.1, -0.2, 0.3);
    body.update(state);
    const Vec3 point = body.pose(last) * local;
    Matrix6X jacobian(6, body.nv());
    body.jacobian(last, point, jacobian);
    for (int k = 0; k < body.nv(); ++k) {
      RobotState still = state;
      still.base_velocity.setZero();
      still.base_angular_velocity.setZero();
      still.qd.setZero();
      if (k < 3) still.base_velocity[k] = 1.0;
      if (k >= 3 && k < 6) still.base_angular_velocity[k - 3] = 1.0;
      if (k >= 6) still.qd[k - 6] = 1.0;
      const Eigen::VectorXd no_acceleration = Eigen::VectorXd::Zero(body.nv());
      near.update(moved(still, no_acceleration, h));
      const Vec3 ahead = near.pose(last) * local;
      const Vec3 com_ahead = near.com();
      const Eigen::Matrix3d turned_ahead = near.rotation(last);
      near.update(moved(still, no_acceleration, -h));
      const Vec3 speed = (ahead - near.pose(last) * local) / (2.0 * h);
      const Vec3 com_speed = (com_ahead - near.com()) / (2.0 * h);
      const Eigen::AngleAxisd turn(turned_ahead * near.rotation(last).transpose());
      EXPECT_NEAR((jacobian.block<3, 1>(0, k) - speed).norm(), 0.0, 1e-8);
      EXPECT_NEAR((jacobian.block<3, 1>(3, k) - turn.axis() * turn.angle() / (2.0 * h)).norm(), 0.0,
                  1e-8);
      EXPECT_NEAR((body.com_jacobian().col(k) - com_speed).norm(), 0.0, 1e-8);
    }
  }
}

TEST(RigidBody, VelocitiesAreJacobiansTimesNu) {
  Random random(6);
  for (const RobotModel& model : models()) {
    RigidBody body(model);
    const RobotState state = random.state(model);
    body.update(state);
    const Eigen::VectorXd nu = generalised_velocity(state);
    Matrix6X jacobian(6, body.nv());
    for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) {
      const Vec3 point = body.position(i) + random.vector();
      body.jacobian(i, point, jacobian);
      EXPECT_NEAR((jacobian * nu - body.velocity(i, point)).norm(), 0.0, 1e-11);
    }
    EXPECT_NEAR((body.com_jacobian() * nu - body.com_velocity()).norm(), 0.0, 1e-12);
  }
}

TEST(RigidBody, BiasAccelerationsAreDerivativesOfVelocities) {
  Random random(7);
  constexpr double h = 1e-5;
  for (const RobotModel& model : models()) {
    RigidBody body(model);
    RigidBody near(model);
    const RobotState state = random.state(model);
    const Eigen::VectorXd nudot =
        10.0 * random.vector(static_cast<Eigen::Index>(6 + model.joint_count()));
    body.update(state, gravity);
    const auto last = static_cast<int>(model.bodies.size()) - 1;
    const Vec3 local(0.1, -0.2, 0.3);
    Matrix6X jacobian(6, body.nv());
    const Vec3 point = body.pose(last) * local;
    body.jacobian(last, point, jacobian);

    struct Motion {
      Vec6 point;
      Vec3 com;
      Vec3 momentum;
    };
    const auto motion = [&](double time) -> Motion {
      const RobotState at = moved(state, nudot, time);
      near.update(at, gravity);
      return {near.velocity(last, near.pose(last) * local), near.com_velocity(),
              near.angular_momentum_matrix() * generalised_velocity(at)};
    };
    const Motion ahead = motion(h);
    const Motion behind = motion(-h);
    const Vec6 acceleration = (ahead.point - behind.point) / (2.0 * h);
    EXPECT_NEAR((jacobian * nudot + body.bias_acceleration(last, point) - acceleration).norm(), 0.0,
                1e-5);
    const Vec3 com_acceleration = (ahead.com - behind.com) / (2.0 * h);
    EXPECT_NEAR(
        (body.com_jacobian() * nudot + body.com_bias_acceleration() - com_acceleration).norm(), 0.0,
        1e-6);
    const Vec3 momentum_rate = (ahead.momentum - behind.momentum) / (2.0 * h);
    EXPECT_NEAR(
        (body.angular_momentum_matrix() * nudot + body.angular_momentum_bias() - momentum_rate)
            .norm(),
        0.0, 1e-5);
  }
}

TEST(RigidBody, NothingIsLostFarFromTheOrigin) {
  const auto robot = load_robot("robots/kasaei");
  RigidBody here(robot->model);
  RigidBody far(robot->model);
  RobotState state = nominal_state(*robot);
  state.qd.setConstant(1.0);
  here.update(state);
  state.base_position += Vec3(1e6, -1e6, 0.0);
  far.update(state);
  EXPECT_EQ(here.mass_matrix(), far.mass_matrix());
  EXPECT_EQ(here.bias(), far.bias());
}

TEST(RigidBody, StandingStillTheBiasIsTheWeight) {
  const auto robot = load_robot("robots/kasaei");
  RigidBody body(robot->model);
  body.update(nominal_state(*robot), gravity);
  EXPECT_NEAR((body.bias().head<3>() - Vec3(0.0, 0.0, 30.0 * gravity)).norm(), 0.0, 1e-10);
  EXPECT_NEAR(body.com_bias_acceleration().norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace stagger::sim
