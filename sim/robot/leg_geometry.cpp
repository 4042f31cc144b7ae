#include "sim/robot/leg_geometry.h"

#include <algorithm>
#include <iterator>

#include "sim/robot/legs.h"

namespace stagger::sim {

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
  const std::vector<int> bodies = leg_bodies(robot, side);
  const auto knee = std::find(bodies.begin(), bodies.end(), pitch[1]);
  for (auto i = std::next(knee); i != bodies.end(); ++i) leg.ankle_joints.push_back(*i - 1);
  return leg;
}

}  // namespace stagger::sim
