#include "sim/robot/foot_acceleration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/robot/leg_geometry.h"
#include "sim/robot/legs.h"
#include "sim/robot/posture.h"

namespace stagger::sim {
namespace {

using engine::Side;

TEST(FootAcceleration, IsAboutThatOfARigidLegOnItsWeakerHip) {
  // With next to no turn of the knee a leg is one body that turns about its hip.
  for (const char* name : {"kasaei", "op3"}) {
    const auto robot = load_robot(std::string("robots/") + name);
    RigidBody body(robot->model);
    body.update(walking_state(*robot));
    const int hip = leg_geometry(*robot, Side::left).hip_body;
    const Vec3 centre = body.position(hip);
    double inertia = 0.0;  // about the lateral axis through the hip
    for (const int i : leg_bodies(*robot, Side::left)) {
      if (i < hip) continue;
      const Body& part = robot->model.bodies[static_cast<std::size_t>(i)];
      const Vec3 arm = body.pose(i) * part.com - centre;
      const Eigen::Matrix3d turned = body.rotation(i) * part.inertia * body.rotation(i).transpose();
      inertia += turned(1, 1) + part.mass * (arm.x() * arm.x() + arm.z() * arm.z());
    }
    const double lever = centre.z() - sole_centre(body, *robot, Side::left).z();
    const double effort = robot->model.bodies[static_cast<std::size_t>(hip)].effort;
    const double rigid = effort * lever / inertia;
    EXPECT_NEAR(foot_acceleration(*robot), rigid, 0.15 * rigid) << name;
  }
}

TEST(FootAcceleration, GoesWithTheTorqueOfTheWeakestJoint) {
  auto robot = std::make_shared<Robot>(*load_robot("robots/kasaei"));
  const double before = foot_acceleration(*robot);
  for (Body& body : robot->model.bodies) body.effort *= 2.0;
  EXPECT_NEAR(foot_acceleration(*robot), 2.0 * before, 1e-9 * before);

  // One leg is enough.
  const int hip = leg_geometry(*robot, Side::right).hip_body;
  robot->model.bodies[static_cast<std::size_t>(hip)].effort *= 0.25;
  EXPECT_NEAR(foot_acceleration(*robot), 0.5 * before, 0.05 * before);

  for (Body& body : robot->model.bodies) body.effort = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isinf(foot_acceleration(*robot)));
}

}  // namespace
}  // namespace stagger::sim
