// From sensor readings to the state of the whole robot.
#pragma once

#include "sim/control/contact_filter.h"
#include "sim/control/joint_filter.h"
#include "sim/control/leg_kinematics.h"
#include "sim/control/sensors.h"

namespace stagger::sim {

/// How the estimator judges what the sensors' data sheets do not tell.
struct EstimatorParameters {
  double joint_acceleration = 40.0;  ///< deviation from tick to tick [rad/s^2]
  double leg_slack = 2e-4;           ///< of a foot seen through the joints, beside encoders [m]
  double start_tilt = 0.002;         ///< of the ground that it is switched on on [rad]
  double start_velocity = 1e-3;      ///< [m/s]
  double plant_load = 0.05;          ///< share of the weight from which on a foot stands
  double lift_load = 0.03;           ///< and below which it does no more
  /// A standing foot creeps by a random walk, more so under little load [m/sqrt(s)].
  double creep = 5e-4;
  double light_creep = 5e-3;
  double light_load = 0.2;  ///< share of the weight below which a load is little
};

/// A Kalman filter for the base on inertial unit and standing feet (ContactFilter), one for the
/// joints (JointFilter). A standing foot may roll over its edge: it turns about its centre of
/// pressure. Ground is assumed to be level and at z = 0 where the robot starts, and nowhere else.
/// World place and yaw are not observable and drift; all parts of the state drift together. No heap
/// after construction.
class Estimator {
 public:
  /// Starts at rest in `start`, which is known but for a small tilt.
  Estimator(const Robot& robot, const SensorParameters& sensors, double dt, double gravity,
            const RobotState& start, const EstimatorParameters& parameters = {});

  /// The state at the end of a tick from what was sensed there.
  void update(const SensorReadings& readings);

  const RobotState& state() const { return state_; }
  const ContactFilter& filter() const { return filter_; }

 private:
  struct Foot {
    LegKinematics leg;
    Eigen::Matrix3d turned;  ///< sole axes in the world, last tick
  };

  void follow_foot(std::size_t i, const SoleLoad& load);

  EstimatorParameters parameters_;
  double dt_;
  double weight_;  ///< [N]
  JointFilter joints_;
  ContactFilter filter_;
  PerFoot<Foot> feet_;
  RobotState state_;
};

}  // namespace stagger::sim
