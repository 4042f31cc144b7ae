#include "sim/robot/leg_geometry.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sim/robot/legs.h"

namespace stagger::sim {
namespace {

constexpr double least_bend = 0.02;  // of a knee that tells which way it bends [rad]

}  // namespace

LegGeometry leg_geometry(const Robot& robot, engine::Side side) {
  RigidBody body(robot.model);
  body.update(nominal_state(robot));
  const std::vector<int> pitch = turning_about(body, robot, side, Vec3::UnitY());
  const std::vector<int> roll = turning_about(body, robot, side, Vec3::UnitX());
  LegGeometry leg;
  if (pitch.size() != 3) return leg;
  leg.hip_body = pitch.front();
  leg.ankle_body = pitch.back();
  if (!roll.empty()) leg.hip_roll_body = roll.front();
  leg.length = leg_length(body, robot);
  const Vec3 thigh = body.position(pitch[1]) - body.position(pitch[0]);
  const Vec3 shank = body.position(pitch[2]) - body.position(pitch[1]);
  const double axis = (body.rotation(pitch[1]) * robot.model.bodies[pitch[1]].axis).y();
  // Of the shank against the thigh, about the lateral axis.
  const double bend = std::atan2(thigh.z() * shank.x() - thigh.x() * shank.z(),
                                 thigh.x() * shank.x() + thigh.z() * shank.z());
  if (std::abs(bend) > least_bend) {
    leg.knee_joint = pitch[1] - 1;
    leg.straight_knee = nominal_state(robot).q[leg.knee_joint] - bend / axis;
    leg.knee_way = std::copysign(1.0, bend / axis);
  }
  const std::vector<int> bodies = leg_bodies(robot, side);
  const auto knee = std::find(bodies.begin(), bodies.end(), pitch[1]);
  for (auto i = std::next(knee); i != bodies.end(); ++i) leg.ankle_joints.push_back(*i - 1);
  return leg;
}

}  // namespace stagger::sim
