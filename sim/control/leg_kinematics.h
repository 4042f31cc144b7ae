// Where a foot's sole is, seen from the base: the joints of one leg and nothing else.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim/robot/robot.h"

namespace stagger::sim {

class LegKinematics {
 public:
  LegKinematics(const Robot& robot, engine::Side side);

  /// Pose of the sole in the base body's frame at these joint angles (all of the robot's) [rad].
  Eigen::Isometry3d sole_in_base(const Eigen::VectorXd& q) const;

 private:
  struct Joint {
    Eigen::Index index;
    Eigen::Isometry3d placement;
    Vec3 axis;
  };
  std::vector<Joint> chain_;  ///< from the base on
  Eigen::Isometry3d sole_;    ///< in the last body's frame
};

}  // namespace stagger::sim
