#include "sim/robot/robot_model.h"

namespace stagger::sim {

double RobotModel::mass() const {
  double sum = 0.0;
  for (const Body& body : bodies) sum += body.mass;
  return sum;
}

std::vector<std::string> RobotModel::joint_names() const {
  std::vector<std::string> names;
  for (std::size_t i = 1; i < bodies.size(); ++i) names.push_back(bodies[i].joint);
  return names;
}

int RobotModel::joint_index(const std::string& joint) const {
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    if (bodies[i].joint == joint) return static_cast<int>(i) - 1;
  }
  return -1;
}

std::vector<Eigen::Isometry3d> body_poses(const RobotModel& model, const RobotState& state) {
  std::vector<Eigen::Isometry3d> poses(model.bodies.size());
  poses[0].setIdentity();
  poses[0].linear() = state.base_orientation.normalized().toRotationMatrix();
  poses[0].translation() = state.base_position;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Body& body = model.bodies[i];
    const double angle = state.q[static_cast<Eigen::Index>(i) - 1];
    poses[i] = poses[body.parent] * body.placement * Eigen::AngleAxisd(angle, body.axis);
  }
  return poses;
}

}  // namespace stagger::sim
