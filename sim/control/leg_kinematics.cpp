#include "sim/control/leg_kinematics.h"

#include <algorithm>

namespace stagger::sim {

LegKinematics::LegKinematics(const Robot& robot, engine::Side side)
    : sole_(robot.sole_in_body(side)) {
  for (int body = robot.foot_body(side); body > 0;) {
    const Body& link = robot.model.bodies[static_cast<std::size_t>(body)];
    chain_.push_back({body - 1, link.placement, link.axis});
    body = link.parent;
  }
  std::reverse(chain_.begin(), chain_.end());
}

Eigen::Isometry3d LegKinematics::sole_in_base(const Eigen::VectorXd& q) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const Joint& joint : chain_) {
    pose.translation() += pose.linear() * joint.placement.translation();
    const Eigen::Matrix3d at_zero = pose.linear() * joint.placement.linear();
    pose.linear().noalias() =
        at_zero * Eigen::AngleAxisd(q[joint.index], joint.axis).toRotationMatrix();
  }
  pose.translation() += pose.linear() * sole_.translation();
  pose.linear() = (pose.linear() * sole_.linear()).eval();
  return pose;
}

}  // namespace stagger::sim
