#include "sim/control/sensors.h"

#include <gtest/gtest.h>

#include "tests/sim/kasaei.h"
#include "tests/sim/random_robot.h"
#include "tests/sim/tick.h"

namespace stagger::sim {
namespace {

SensorParameters noiseless() {
  SensorParameters p;
  p.imu.gyro_noise = p.imu.gyro_bias = 0.0;
  p.imu.accelerometer_noise = p.imu.accelerometer_bias = 0.0;
  p.encoder = {0.0, 0.0};
  p.foot = {0.0, 0.0, 0.0, 0.0};
  return p;
}

/// In the air with random orientation and velocities.
RobotState random_start(Random& random) {
  RobotState state = random.state(kasaei()->model);
  state.base_position = random.vector();
  return state;
}

Sensors make(const SensorParameters& parameters, std::uint64_t seed, const RobotState& start) {
  return Sensors(*kasaei(), parameters, seed, dt, gravity, start);
}

struct Statistics {
  double mean = 0.0;
  double deviation = 0.0;
};

Statistics statistics(const std::vector<double>& values) {
  const Eigen::Map<const Eigen::ArrayXd> v(values.data(), static_cast<Eigen::Index>(values.size()));
  return {v.mean(), std::sqrt((v - v.mean()).square().mean())};
}

TEST(Sensors, TheAccelerometerFeelsTheWeightAtRestAndNothingInFreeFall) {
  Random random(1);
  RobotState state = random_start(random);
  state.base_angular_velocity.setZero();
  Sensors sensors = make(noiseless(), 1, state);
  const Vec3 up = state.base_orientation.conjugate() * Vec3(0.0, 0.0, gravity);
  EXPECT_NEAR((sensors.read(state, {}).specific_force - up).norm(), 0.0, 1e-9);
  state.base_velocity.z() -= dt * gravity;
  EXPECT_NEAR(sensors.read(state, {}).specific_force.norm(), 0.0, 1e-9);
}

TEST(Sensors, WhatTheInertialUnitTellsAddsUpToTheMotion) {
  // Through a push of hundreds of m/s^2 while it turns at some rad/s.
  Random random(2);
  RobotState state = random_start(random);
  Sensors sensors = make(noiseless(), 1, state);
  Eigen::Quaterniond orientation = state.base_orientation;
  Vec3 velocity = state.base_velocity;
  for (int i = 0; i < 200; ++i) {
    Eigen::VectorXd acceleration = 300.0 * random.vector(18);
    state = moved(state, acceleration, dt);
    const SensorReadings& readings = sensors.read(state, {});
    const Vec3 turn = dt * readings.angular_velocity;
    const auto by = [&](double share) {
      return Eigen::Quaterniond(Eigen::AngleAxisd(share * turn.norm(), turn.normalized()));
    };
    velocity += dt * (orientation * by(0.5) * readings.specific_force - Vec3(0.0, 0.0, gravity));
    orientation = orientation * by(1.0);
  }
  EXPECT_LT(orientation.angularDistance(state.base_orientation), 1e-9);
  EXPECT_LT((velocity - state.base_velocity).norm(), 1e-9);
}

TEST(Sensors, NoiseHasItsDeviationAndABiasStays) {
  Random random(3);
  RobotState state = random_start(random);
  SensorParameters p;
  p.imu.gyro_bias = 0.0;
  p.imu.accelerometer_bias = 0.5;
  Sensors sensors = make(p, 7, state);
  const Vec3 up = state.base_orientation.conjugate() * Vec3(0.0, 0.0, gravity);
  std::vector<double> gyro;
  std::vector<double> force_early;
  std::vector<double> force_late;
  std::vector<double> q;
  std::vector<double> qd;
  constexpr int n = 10000;
  for (int i = 0; i < n; ++i) {
    const SensorReadings& readings = sensors.read(state, {});
    gyro.push_back(readings.angular_velocity.x());
    (i < n / 2 ? force_early : force_late).push_back(readings.specific_force.y() - up.y());
    q.push_back(readings.q[3] - state.q[3]);
    qd.push_back(readings.qd[3] - state.qd[3]);
  }
  EXPECT_NEAR(statistics(gyro).deviation, p.imu.gyro_noise, 0.05 * p.imu.gyro_noise);
  EXPECT_NEAR(statistics(gyro).mean, 0.0, 0.05 * p.imu.gyro_noise);
  EXPECT_NEAR(statistics(q).deviation, p.encoder.position_noise, 0.05 * p.encoder.position_noise);
  EXPECT_NEAR(statistics(qd).deviation, p.encoder.velocity_noise, 0.05 * p.encoder.velocity_noise);
  EXPECT_NEAR(statistics(force_early).mean, statistics(force_late).mean, 0.003);
  EXPECT_GT(std::abs(statistics(force_early).mean), 0.02);  // a bias, not 0
}

TEST(Sensors, TheSeedFixesEverything) {
  Random random(4);
  const RobotState state = random_start(random);
  const PerFoot<SoleLoad> loads{SoleLoad{100.0, {0.01, 0.0}}, SoleLoad{200.0, {0.0, 0.01}}};
  const auto thousandth = [&](std::uint64_t seed) {
    Sensors sensors = make({}, seed, state);
    for (int i = 0; i < 999; ++i) sensors.read(state, loads);
    return sensors.read(state, loads);
  };
  const SensorReadings a = thousandth(5);
  const SensorReadings b = thousandth(5);
  EXPECT_EQ(a.specific_force, b.specific_force);
  EXPECT_EQ(a.angular_velocity, b.angular_velocity);
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.soles[1].cop, b.soles[1].cop);
  EXPECT_NE(a.specific_force, thousandth(6).specific_force);
  EXPECT_NE(a.soles[0].force, thousandth(6).soles[0].force);
}

TEST(Sensors, OneSensorsNoiseLeavesTheOthersAlone) {
  Random random(5);
  const RobotState state = random_start(random);
  SensorParameters other;
  other.encoder = {0.01, 1.0};
  Sensors a = make({}, 5, state);
  Sensors b = make(other, 5, state);
  a.read(state, {});
  b.read(state, {});
  EXPECT_EQ(a.readings().specific_force, b.readings().specific_force);
  EXPECT_NE(a.readings().q, b.readings().q);
}

TEST(Sensors, ADelayedInertialUnitTellsWhatWas) {
  Random random(6);
  RobotState state = random_start(random);
  SensorParameters late = noiseless();
  late.imu.delay_ticks = 3;
  Sensors now = make(noiseless(), 1, state);
  Sensors then = make(late, 1, state);
  std::vector<Vec3> forces;
  for (int i = 0; i < 10; ++i) {
    state = moved(state, 10.0 * random.vector(18), dt);
    forces.push_back(now.read(state, {}).specific_force);
    const Vec3& delayed = then.read(state, {}).specific_force;
    if (i >= 3) {
      EXPECT_EQ(delayed, forces[static_cast<std::size_t>(i) - 3]);
    }
  }
}

TEST(Sensors, ForceNoiseGrowsWithTheRobotsWeight) {
  const auto noise = [](double scale) {
    Robot robot = *kasaei();
    for (Body& body : robot.model.bodies) body.mass *= scale;
    Sensors sensors(robot, {}, 1, dt, gravity, nominal_state(robot));
    std::vector<double> force;
    for (int i = 0; i < 2000; ++i)
      force.push_back(sensors.read(nominal_state(robot), {}).soles[0].force);
    return statistics(force);
  };
  const Statistics one = noise(1.0);
  const Statistics tenth = noise(0.1);
  EXPECT_NEAR(one.deviation, 0.002 * 30.0 * gravity, 0.1 * one.deviation);
  EXPECT_NEAR(tenth.deviation, 0.1 * one.deviation, 1e-9);
  EXPECT_NEAR(tenth.mean, 0.1 * one.mean, 1e-9);
}

TEST(Sensors, TheCentreOfPressureBlursUnderLittleLoadAndStaysOnTheSole) {
  const RobotState state = nominal_state(*kasaei());
  const auto cop_deviation = [&](double force) {
    Sensors sensors = make({}, 3, state);
    std::vector<double> x;
    for (int i = 0; i < 2000; ++i) {
      const Vec2 cop = sensors.read(state, {SoleLoad{force, {0.02, 0.01}}, {}}).soles[0].cop;
      EXPECT_LE(std::abs(cop.x()), 0.075);
      EXPECT_LE(std::abs(cop.y()), 0.0375);
      x.push_back(cop.x());
    }
    return statistics(x);
  };
  EXPECT_NEAR(cop_deviation(294.3).mean, 0.02, 0.003);
  EXPECT_LT(cop_deviation(294.3).deviation, 0.0005);
  EXPECT_GT(cop_deviation(15.0).deviation, 10.0 * cop_deviation(294.3).deviation);
  Sensors sensors = make(noiseless(), 1, state);
  EXPECT_EQ(sensors.read(state, {}).soles[0].cop, Vec2(0.0, 0.0));
}

}  // namespace
}  // namespace stagger::sim
