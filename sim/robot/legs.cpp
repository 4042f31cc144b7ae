#include "sim/robot/legs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stagger::sim {

using engine::Side;
using engine::Vec2;

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

std::vector<int> turning_about(const RigidBody& body, const Robot& robot, Side side,
                               const Vec3& direction) {
  std::vector<int> found;
  for (const int i : leg_bodies(robot, side)) {
    const Vec3 axis = body.rotation(i) * robot.model.bodies[i].axis;
    if (std::abs(axis.dot(direction)) > M_SQRT1_2) found.push_back(i);
  }
  return found;
}

Vec3 sole_centre(const RigidBody& body, const Robot& robot, Side side) {
  return body.pose(robot.foot_body(side)) * robot.sole_in_body(side).translation();
}

std::vector<int> leg_hinges(const RigidBody& body, const Robot& robot) {
  std::vector<int> hinges = turning_about(body, robot, Side::left, Vec3::UnitY());
  return hinges.size() < 2 ? leg_bodies(robot, Side::left) : hinges;
}

double leg_length(const RigidBody& body, const Robot& robot) {
  const std::vector<int> hinges = leg_hinges(body, robot);
  double length = 0.0;
  for (std::size_t i = 1; i < hinges.size(); ++i) {
    // Only forwards and upwards: hip and knee may sit beside each other.
    const Vec3 way = body.position(hinges[i]) - body.position(hinges[i - 1]);
    length += std::hypot(way.x(), way.z());
  }
  return length;
}

double hip_height(const RigidBody& body, const Robot& robot) {
  const std::vector<int> hinges = leg_hinges(body, robot);
  return body.position(hinges.front()).z() - body.position(hinges.back()).z();
}

Vec2 ankle_zmp_reach(const Robot& robot, double gravity) {
  RigidBody body(robot.model);
  body.update(nominal_state(robot));
  const double weight = body.mass() * gravity;
  Vec2 reach = Vec2::Constant(std::numeric_limits<double>::infinity());
  for (const Side side : {Side::left, Side::right}) {
    const Vec3 sole = sole_centre(body, robot, side);
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
