#include "sim/control/estimator.h"

#include <algorithm>
#include <cmath>

namespace stagger::sim {
namespace {

/// Bias of a MEMS unit in run, as a random walk [rad/s^2/sqrt(Hz)], [m/s^3/sqrt(Hz)].
constexpr double gyro_walk = 1e-5;
constexpr double accelerometer_walk = 1e-5;

ContactFilterNoise filter_noise(const Robot& robot, const SensorParameters& sensors,
                                const EstimatorParameters& parameters) {
  ContactFilterNoise noise;
  noise.gyro = std::max(sensors.imu.gyro_noise, 1e-5);
  noise.accelerometer = std::max(sensors.imu.accelerometer_noise, 1e-4);
  noise.gyro_walk = gyro_walk;
  noise.accelerometer_walk = accelerometer_walk;
  // Three joints turn the foot about each axis, with no more than the leg's length as lever.
  const double reach = robot.description.walk.com_height_m;
  noise.leg = std::hypot(parameters.leg_slack, sensors.encoder.position_noise * reach);
  noise.start_tilt = parameters.start_tilt;
  noise.start_velocity = parameters.start_velocity;
  noise.gyro_bias = std::max(sensors.imu.gyro_bias, 1e-6);
  noise.accelerometer_bias = std::max(sensors.imu.accelerometer_bias, 1e-5);
  return noise;
}

}  // namespace

Estimator::Estimator(const Robot& robot, const SensorParameters& sensors, double dt, double gravity,
                     const RobotState& start, const EstimatorParameters& parameters)
    : parameters_(parameters),
      dt_(dt),
      weight_(robot.model.mass() * gravity),
      joints_(sensors.encoder, parameters.joint_acceleration, dt, start.q),
      filter_(filter_noise(robot, sensors, parameters), dt, gravity, start.base_position,
              start.base_orientation),
      feet_{Foot{LegKinematics(robot, engine::Side::left), {}},
            Foot{LegKinematics(robot, engine::Side::right), {}}},
      state_(start) {
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Isometry3d sole = feet_[i].leg.sole_in_base(start.q);
    feet_[i].turned = start.base_orientation.toRotationMatrix() * sole.linear();
    filter_.plant(i, sole.translation());
  }
}

void Estimator::follow_foot(std::size_t i, const SoleLoad& load) {
  Foot& foot = feet_[i];
  const Eigen::Isometry3d sole = foot.leg.sole_in_base(joints_.q());
  const Eigen::Matrix3d turned = filter_.orientation().toRotationMatrix() * sole.linear();
  const double share = load.force / weight_;
  if (share < parameters_.lift_load) {
    filter_.lift(i);
  } else if (filter_.stands(i)) {
    // What touches the ground stays: the centre of pressure, about which the foot may turn.
    const Vec3 pivot(load.cop.x(), load.cop.y(), 0.0);
    const Vec3 way = (foot.turned - turned) * pivot;
    const double light = std::max(0.0, 1.0 - share / parameters_.light_load);
    const double creep = parameters_.creep + light * parameters_.light_creep;
    filter_.shift(i, way, creep * std::sqrt(dt_));
    filter_.see(i, sole.translation());
  } else if (share > parameters_.plant_load) {
    filter_.plant(i, sole.translation());
  }
  foot.turned = turned;
}

void Estimator::update(const SensorReadings& readings) {
  joints_.update(readings.q, readings.qd);
  filter_.predict(readings.angular_velocity, readings.specific_force);
  for (std::size_t i = 0; i < 2; ++i) follow_foot(i, readings.soles[i]);
  state_.base_position = filter_.position();
  state_.base_orientation = filter_.orientation();
  state_.base_velocity = filter_.velocity();
  state_.base_angular_velocity = filter_.angular_velocity();
  state_.q = joints_.q();
  state_.qd = joints_.qd();
}

}  // namespace stagger::sim
