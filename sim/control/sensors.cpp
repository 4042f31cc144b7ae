#include "sim/control/sensors.h"

#include <algorithm>

namespace stagger::sim {
namespace {

/// A centre of pressure is told from this share of the weight on.
constexpr double least_load_share = 0.01;

/// Streams of the seed.
enum Stream : std::uint64_t { imu_stream = 1, encoder_stream, foot_stream, bias_stream };

Vec3 noise3(Noise& noise) {
  Vec3 v;
  for (double& x : v) x = noise();
  return v;
}

}  // namespace

Sensors::Sensors(const Robot& robot, const SensorParameters& parameters, std::uint64_t seed,
                 double dt, double gravity, const RobotState& start)
    : parameters_(parameters),
      dt_(dt),
      gravity_(gravity),
      weight_(robot.model.mass() * gravity),
      imu_noise_(seed, imu_stream),
      encoder_noise_(seed, encoder_stream),
      foot_noise_(seed, foot_stream),
      last_velocity_(start.base_velocity),
      last_orientation_(start.base_orientation) {
  Noise bias(seed, bias_stream);
  gyro_bias_ = parameters.imu.gyro_bias * noise3(bias);
  accelerometer_bias_ = parameters.imu.accelerometer_bias * noise3(bias);
  for (std::size_t foot = 0; foot < 2; ++foot) {
    const SoleDescription& sole = robot.description.feet[foot].sole;
    sole_length_[foot] = sole.length;
    half_sole_[foot] = {0.5 * sole.length, 0.5 * sole.width};
    force_bias_[foot] = parameters.foot.force_bias * weight_ * bias();
    moment_bias_[foot].x() = parameters.foot.moment_bias * weight_ * sole.length * bias();
    moment_bias_[foot].y() = parameters.foot.moment_bias * weight_ * sole.length * bias();
  }
  readings_.q = start.q;
  readings_.qd = start.qd;
  const Vec3 at_rest = start.base_orientation.conjugate() * Vec3(0.0, 0.0, gravity);
  imu_ring_.assign(static_cast<std::size_t>(parameters.imu.delay_ticks),
                   {gyro_bias_, at_rest + accelerometer_bias_});
}

Sensors::ImuSample Sensors::sample_imu(const RobotState& now) {
  ImuSample sample;
  const Eigen::AngleAxisd turn(last_orientation_.conjugate() * now.base_orientation);
  const Vec3 angle = turn.angle() * turn.axis();
  // A strapdown unit sums up over the tick in its own axes: those of the middle of the turn.
  const Eigen::Quaterniond middle =
      last_orientation_ * Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * turn.angle(), turn.axis()));
  const Vec3 acceleration = (now.base_velocity - last_velocity_) / dt_;
  sample.angular_velocity =
      angle / dt_ + gyro_bias_ + parameters_.imu.gyro_noise * noise3(imu_noise_);
  sample.specific_force = middle.conjugate() * (acceleration + Vec3(0.0, 0.0, gravity_)) +
                          accelerometer_bias_ +
                          parameters_.imu.accelerometer_noise * noise3(imu_noise_);
  last_velocity_ = now.base_velocity;
  last_orientation_ = now.base_orientation;
  return sample;
}

SoleLoad Sensors::sample_sole(std::size_t foot, const SoleLoad& truth) {
  const FootForceParameters& p = parameters_.foot;
  SoleLoad load;
  load.force = truth.force + force_bias_[foot] + p.force_noise * weight_ * foot_noise_();
  const double moment_noise = p.moment_noise * weight_ * sole_length_[foot];
  Vec2 moment = truth.force * truth.cop + moment_bias_[foot];
  for (double& component : moment) component += moment_noise * foot_noise_();
  if (load.force > least_load_share * weight_) {
    load.cop = (moment / load.force).cwiseMax(-half_sole_[foot]).cwiseMin(half_sole_[foot]);
  }
  return load;
}

const SensorReadings& Sensors::read(const RobotState& now, const PerFoot<SoleLoad>& soles) {
  ImuSample sample = sample_imu(now);
  if (!imu_ring_.empty()) {
    std::swap(sample, imu_ring_[oldest_]);
    oldest_ = (oldest_ + 1) % imu_ring_.size();
  }
  readings_.angular_velocity = sample.angular_velocity;
  readings_.specific_force = sample.specific_force;
  for (Eigen::Index i = 0; i < readings_.q.size(); ++i) {
    readings_.q[i] = now.q[i] + parameters_.encoder.position_noise * encoder_noise_();
    readings_.qd[i] = now.qd[i] + parameters_.encoder.velocity_noise * encoder_noise_();
  }
  for (std::size_t foot = 0; foot < 2; ++foot) {
    readings_.soles[foot] = sample_sole(foot, soles[foot]);
  }
  return readings_;
}

}  // namespace stagger::sim
