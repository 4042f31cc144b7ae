#include "sim/robot/leg_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stagger::sim {
namespace {

/// An axis within about 35 degrees of another counts as parallel to it.
constexpr double least_alignment = 0.82;
constexpr int knee_samples = 200;

}  // namespace

LegGeometry leg_geometry(const Robot& robot, engine::Side side) {
  const RobotModel& model = robot.model;
  LegGeometry leg;
  for (int i = robot.foot_body(side); i > 0; i = model.bodies[static_cast<std::size_t>(i)].parent) {
    leg.bodies.insert(leg.bodies.begin(), i);
  }
  RobotState state = nominal_state(robot);
  const auto poses = body_poses(model, state);
  std::vector<int> pitch;
  for (const int body : leg.bodies) {
    const auto i = static_cast<std::size_t>(body);
    const Vec3 axis = poses[i].linear() * model.bodies[i].axis;
    if (std::abs(axis.y()) > least_alignment) pitch.push_back(body);
    if (std::abs(axis.x()) > least_alignment && leg.hip_roll_body < 0) leg.hip_roll_body = body;
  }
  if (pitch.size() != 3) return leg;
  leg.hip_body = pitch[0];
  leg.knee_body = pitch[1];
  leg.ankle_body = pitch[2];
  const Body& knee = model.bodies[static_cast<std::size_t>(leg.knee_body)];
  const double lower = std::max(knee.lower, -std::numbers::pi);
  const double upper = std::min(knee.upper, std::numbers::pi);
  for (int k = 0; k <= knee_samples; ++k) {
    state.q[leg.knee_body - 1] = lower + (upper - lower) * k / knee_samples;
    const auto bent = body_poses(model, state);
    const double distance = (bent[static_cast<std::size_t>(leg.hip_body)].translation() -
                             bent[static_cast<std::size_t>(leg.ankle_body)].translation())
                                .norm();
    leg.length = std::max(leg.length, distance);
  }
  return leg;
}

}  // namespace stagger::sim
