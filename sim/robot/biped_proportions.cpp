#include "sim/robot/biped_proportions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/robot/rigid_body.h"

namespace stagger::sim {
namespace {

using engine::Side;
using engine::Vec2;

/// A joint whose axis is nearer than 45 degrees to a direction turns about it.
constexpr double along = 0.7;

/// World axis of the joint that carries the body.
Vec3 axis_of(const RigidBody& body, const RobotModel& model, int index) {
  return body.rotation(index) * model.bodies[index].axis;
}

/// Bodies of the leg whose joints turn about that direction (unit, world), from the hip down.
std::vector<int> turning_about(const RigidBody& body, const Robot& robot, Side side,
                               const Vec3& direction) {
  std::vector<int> found;
  for (const int index : leg_bodies(robot, side)) {
    if (std::abs(axis_of(body, robot.model, index).dot(direction)) > along) found.push_back(index);
  }
  return found;
}

/// Length in the plane that is normal to y: hips and ankles may sit beside each other.
double sagittal_distance(const Vec3& a, const Vec3& b) {
  return std::hypot(a.x() - b.x(), a.z() - b.z());
}

}  // namespace

std::vector<int> leg_bodies(const Robot& robot, Side side) {
  const auto chain = [&](Side of) {
    std::vector<int> bodies;
    for (int i = robot.foot_body(of); i > 0; i = robot.model.bodies[i].parent) bodies.push_back(i);
    std::reverse(bodies.begin(), bodies.end());
    return bodies;
  };
  std::vector<int> leg = chain(side);
  const std::vector<int> rest = chain(engine::other(side));
  std::erase_if(leg, [&](int i) { return std::find(rest.begin(), rest.end(), i) != rest.end(); });
  return leg;
}

BipedProportions biped_proportions(const Robot& robot) {
  RigidBody body(robot.model);
  body.update(nominal_state(robot));
  BipedProportions proportions;
  proportions.com_height = body.com().z();
  proportions.sole_width = robot.description.feet[0].sole.width;
  const auto sole = [&](Side side) -> Vec3 {
    return (body.pose(robot.foot_body(side)) * robot.sole_in_body(side)).translation();
  };
  proportions.stance_width = (sole(Side::left) - sole(Side::right)).head<2>().norm();

  std::vector<int> hinges = turning_about(body, robot, Side::left, Vec3::UnitY());
  if (hinges.size() < 2) hinges = leg_bodies(robot, Side::left);
  for (std::size_t i = 1; i < hinges.size(); ++i) {
    proportions.leg_length +=
        sagittal_distance(body.position(hinges[i - 1]), body.position(hinges[i]));
  }
  proportions.hip_height = body.position(hinges.front()).z() - body.position(hinges.back()).z();
  return proportions;
}

Vec2 ankle_zmp_reach(const Robot& robot, double gravity) {
  RigidBody body(robot.model);
  body.update(nominal_state(robot));
  const double weight = body.mass() * gravity;
  Vec2 reach = Vec2::Constant(std::numeric_limits<double>::infinity());
  for (const Side side : {Side::left, Side::right}) {
    const Vec3 sole = (body.pose(robot.foot_body(side)) * robot.sole_in_body(side)).translation();
    for (const int axis : {0, 1}) {
      // The ZMP moves along x by the joint that turns about y, and the other way about.
      const Vec3 turned = axis == 0 ? Vec3::UnitY() : Vec3::UnitX();
      const std::vector<int> joints = turning_about(body, robot, side, turned);
      if (joints.empty()) continue;
      const int ankle = joints.back();
      const double off = std::abs(body.position(ankle)[axis] - sole[axis]);
      const double effort = robot.model.bodies[ankle].effort;
      reach[axis] = std::min(reach[axis], std::max(effort / weight - off, 0.0));
    }
  }
  return reach;
}

}  // namespace stagger::sim
