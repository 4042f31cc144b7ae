#include "sim/robot/foot_acceleration.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/robot/legs.h"
#include "sim/robot/posture.h"

namespace stagger::sim {

using engine::Side;

double foot_acceleration(const Robot& robot) {
  RigidBody body(robot.model);
  body.update(walking_state(robot));
  double least = std::numeric_limits<double>::infinity();
  for (const Side side : {Side::left, Side::right}) {
    Matrix6X all(6, body.nv());
    body.jacobian(robot.foot_body(side), sole_centre(body, robot, side), all);
    const std::vector<int> leg = leg_bodies(robot, side);
    const auto joints = static_cast<Eigen::Index>(leg.size());
    Matrix6X jacobian(6, joints);
    Eigen::MatrixXd mass(joints, joints);
    constexpr int base = 5;  // joint i moves body i + 1, behind the base's six velocities
    for (Eigen::Index i = 0; i < joints; ++i) {
      const int at = base + leg[static_cast<std::size_t>(i)];
      jacobian.col(i) = all.col(at);
      for (Eigen::Index k = 0; k < joints; ++k) {
        mass(k, i) = body.mass_matrix()(base + leg[static_cast<std::size_t>(k)], at);
      }
    }
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> motion(jacobian);
    for (const Eigen::Index axis : {0, 1}) {
      // From rest, along that axis alone, without a turn.
      const Eigen::VectorXd torque = mass * motion.solve(Eigen::VectorXd::Unit(6, axis));
      for (Eigen::Index i = 0; i < joints; ++i) {
        const double effort =
            robot.model.bodies[static_cast<std::size_t>(leg[static_cast<std::size_t>(i)])].effort;
        const double asked = std::abs(torque[i]);
        if (asked > 0.0) least = std::min(least, effort / asked);
      }
    }
  }
  return least;
}

}  // namespace stagger::sim
