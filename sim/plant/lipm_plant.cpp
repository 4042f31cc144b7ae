#include "sim/plant/lipm_plant.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stagger::sim {
namespace {

Vec2 dcm_of(const engine::Measurement& m, double omega) {
  return m.com.head<2>() + m.com_velocity.head<2>() / omega;
}

}  // namespace

LipmPlant::LipmPlant(const Robot& robot, double dt) : mass_(robot.model.mass()), dt_(dt) {
  const BipedDescription& d = robot.description;
  omega_ = std::sqrt(gravity_ / d.walk.com_height_m);
  // Farther from the feet than the longest step nothing can catch it any more.
  reach_ = 2.0 * d.walk.max_step_length_m;
  sole_ = {0.5 * d.feet[0].sole.length, 0.5 * d.feet[0].sole.width};
  lipm_ = engine::discretise(omega_, dt);
  measurement_.com = {0.0, 0.0, d.walk.com_height_m};
  for (const Side side : {Side::left, Side::right}) {
    const double y = engine::lateral_sign(side) * 0.5 * d.walk.stance_width_m;
    measurement_.feet[engine::index(side)].position = {0.0, y, 0.0};
    measurement_.foot_load[engine::index(side)] = 0.5 * mass_ * gravity_;
  }
}

void LipmPlant::step(const engine::WalkingTargets& targets, std::span<const AppliedForce> forces) {
  if (released_) return;
  auto& feet = measurement_.feet;
  support_ = targets.support_side;
  for (const Side side : {Side::left, Side::right}) {
    const engine::FootTarget& target = targets.feet[engine::index(side)];
    FootPose& foot = feet[engine::index(side)];
    if (!target.in_contact) {
      foot.position = target.position;
      foot.position.z() = std::max(0.0, target.position.z());
      foot.yaw = target.yaw;
    }
  }
  const bool single = targets.state == WalkingState::single_support;
  const FootPose& stance = feet[engine::index(support_)];
  const engine::SupportPolygon polygon = single
                                             ? engine::SupportPolygon(sole_, stance)
                                             : engine::SupportPolygon(sole_, feet[0], feet[1]);
  const Vec2 zmp = polygon.clamp(targets.zmp_command);

  Vec3 force = Vec3::Zero();
  for (const AppliedForce& applied : forces) force += applied.force;
  // A constant force is a shift of the ZMP: w^2 (c - p) + F/m = w^2 (c - (p - F/(m w^2))).
  const Vec2 effective = zmp - force.head<2>() / (mass_ * omega_ * omega_);
  Eigen::Matrix2d state;
  state.row(0) = measurement_.com.head<2>();
  state.row(1) = dcm_of(measurement_, omega_);
  state = (lipm_.a * state + lipm_.b * effective.transpose()).eval();
  measurement_.com.head<2>() = state.row(0);
  measurement_.com_velocity.head<2>() = omega_ * (state.row(1) - state.row(0)).transpose();
  measurement_.zmp = zmp;

  // The weight on each foot follows from where the ZMP is between the feet.
  const Vec2 between = (feet[1].position - feet[0].position).head<2>();
  const double along = (zmp - feet[0].position.head<2>()).dot(between) / between.squaredNorm();
  const double right = std::clamp(along, 0.0, 1.0);
  const double weight = mass_ * gravity_;
  if (single) {
    // The swing foot has landed when it is down; its share of the load is a matter of convention.
    const std::size_t swing = engine::index(engine::other(support_));
    measurement_.foot_load[swing] = feet[swing].position.z() <= 0.0 ? 0.5 * weight : 0.0;
    measurement_.foot_load[engine::index(support_)] = weight - measurement_.foot_load[swing];
  } else {
    measurement_.foot_load = {(1.0 - right) * weight, right * weight};
  }
}

void LipmPlant::describe(Frame& frame) const {
  frame.com = measurement_.com;
  frame.com_velocity = measurement_.com_velocity;
  frame.dcm = dcm_of(measurement_, omega_);
  frame.zmp = measurement_.zmp;
  frame.base_position = measurement_.com;
  frame.base_orientation = Eigen::Quaterniond::Identity();
  frame.feet = measurement_.feet;
  frame.foot_load = measurement_.foot_load;
  frame.joint_count = 0;
}

std::string LipmPlant::fall_reason() const {
  const Vec2 dcm = dcm_of(measurement_, omega_);
  double distance = std::numeric_limits<double>::infinity();
  for (const FootPose& foot : measurement_.feet) {
    distance = std::min(distance, (dcm - foot.position.head<2>()).norm());
  }
  if (distance <= reach_) return {};
  return "the DCM is out of reach of any step";
}

void LipmPlant::mix_state(StateHash& hash) const {
  for (int axis = 0; axis < 2; ++axis) {
    hash.mix(measurement_.com[axis]);
    hash.mix(measurement_.com_velocity[axis]);
    hash.mix(measurement_.zmp[axis]);
    for (const FootPose& foot : measurement_.feet) hash.mix(foot.position[axis]);
  }
}

}  // namespace stagger::sim
