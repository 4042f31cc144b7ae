// What a real biped senses: an inertial unit on its base, encoders at its joints, forces under its
// feet. Truth goes in, readings with noise, bias and delay come out.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "sim/noise.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

using engine::PerFoot;
using engine::Vec2;

/// MEMS unit of the VN-100 class: gyro 0.0035 deg/s/sqrt(Hz), accelerometer 0.14 mg/sqrt(Hz), both
/// over a band of 500 Hz; biases are what a factory calibration leaves. Standard deviations; a bias
/// is drawn once for each axis. No limit of range and no misalignment.
struct ImuParameters {
  static constexpr int max_delay_ticks = 20;

  double gyro_noise = 0.0014;          ///< [rad/s]
  double gyro_bias = 0.0017;           ///< 0.1 deg/s [rad/s]
  double accelerometer_noise = 0.031;  ///< [m/s^2]
  double accelerometer_bias = 0.02;    ///< 2 mg [m/s^2]
  int delay_ticks = 0;                 ///< age of a reading, 0 to max_delay_ticks
  bool operator==(const ImuParameters&) const = default;
};

/// Magnetic absolute encoder of 14 bits at the joint's output (a count is 3.8e-4 rad: 1.1e-4 rad
/// rms) and the motor's own encoder behind the gear for the velocity. Standard deviations.
struct EncoderParameters {
  double position_noise = 1e-4;  ///< [rad]
  double velocity_noise = 0.02;  ///< [rad/s]
  bool operator==(const EncoderParameters&) const = default;
};

/// Six-axis force sensor in the ankle, in shares of what the robot weighs, so that they suit one of
/// 3 kg as well as one of 70 kg: noise 0.2 %, bias 0.5 % of full scale are common. Moments are in
/// shares of weight times the sole's length. Standard deviations; biases are drawn once.
struct FootForceParameters {
  double force_noise = 0.002;
  double force_bias = 0.005;
  double moment_noise = 0.002;
  double moment_bias = 0.005;
  bool operator==(const FootForceParameters&) const = default;
};

struct SensorParameters {
  ImuParameters imu;
  EncoderParameters encoder;
  FootForceParameters foot;
  bool operator==(const SensorParameters&) const = default;
};

/// What presses on a sole, in the sole's frame.
struct SoleLoad {
  double force = 0.0;       ///< normal to the sole [N]
  Vec2 cop = Vec2::Zero();  ///< centre of pressure; the sole's centre where hardly any load is [m]
};

struct SensorReadings {
  Vec3 angular_velocity = Vec3::Zero();  ///< gyro, base axes, mean over the tick [rad/s]
  Vec3 specific_force = Vec3::Zero();    ///< accelerometer, base axes, mean over the tick [m/s^2]
  Eigen::VectorXd q;                     ///< [rad]
  Eigen::VectorXd qd;                    ///< [rad/s]
  PerFoot<SoleLoad> soles;
};

/// The unit sits at the origin of the base body's frame. No heap after construction.
class Sensors {
 public:
  /// The seed fixes all biases and noises. `start` is the state at rest in which it begins.
  Sensors(const Robot& robot, const SensorParameters& parameters, std::uint64_t seed, double dt,
          double gravity, const RobotState& start);

  /// Readings at the end of a tick that led to `now`, with what then pressed on the soles.
  const SensorReadings& read(const RobotState& now, const PerFoot<SoleLoad>& soles);
  const SensorReadings& readings() const { return readings_; }

 private:
  struct ImuSample {
    Vec3 angular_velocity = Vec3::Zero();
    Vec3 specific_force = Vec3::Zero();
  };

  ImuSample sample_imu(const RobotState& now);
  SoleLoad sample_sole(std::size_t foot, const SoleLoad& truth);

  SensorParameters parameters_;
  double dt_;
  double gravity_;
  double weight_;                ///< [N]
  PerFoot<double> sole_length_;  ///< [m]
  PerFoot<Vec2> half_sole_;      ///< [m]
  Noise imu_noise_;
  Noise encoder_noise_;
  Noise foot_noise_;
  Vec3 gyro_bias_;
  Vec3 accelerometer_bias_;
  PerFoot<double> force_bias_{};  ///< [N]
  PerFoot<Vec2> moment_bias_;     ///< of (force x, force y) [N m]
  Vec3 last_velocity_;
  Eigen::Quaterniond last_orientation_;
  std::vector<ImuSample> imu_ring_;
  std::size_t oldest_ = 0;
  SensorReadings readings_;
};

}  // namespace stagger::sim
