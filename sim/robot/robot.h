// A robot as this project knows it: a URDF model and the small description beside it.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/robot/biped_description.h"
#include "sim/robot/robot_model.h"

namespace stagger::sim {

struct Robot {
  std::string name;
  std::filesystem::path folder;  ///< holds robot.urdf and robot.json
  RobotModel model;
  BipedDescription description;

  /// Index of the body that the foot's link belongs to.
  int foot_body(engine::Side side) const;
  /// Frame of the sole in that body: origin at the sole's centre, x along its length, z up.
  Eigen::Isometry3d sole_in_body(engine::Side side) const;
  /// Axes of the torso (x forward, z up when it is upright) in the frame of its body.
  Eigen::Matrix3d torso_in_body() const;
};

/// Reads folder/robot.json and the URDF that it names. Throws std::runtime_error with a message
/// that names the file, the field, its value and what is allowed.
std::shared_ptr<const Robot> load_robot(const std::filesystem::path& folder);

/// Names of the robots in a folder of robots, sorted.
std::vector<std::string> list_robots(const std::filesystem::path& robots);

/// At rest with these joint angles: soles on the ground (z = 0), their mid-point at the world's
/// origin, the left one pointing along x. The base is turned so that the left sole is flat.
RobotState standing_state(const Robot& robot, const Eigen::VectorXd& q);

/// The same in the nominal pose.
RobotState nominal_state(const Robot& robot);

}  // namespace stagger::sim
