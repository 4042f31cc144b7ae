#include "sim/plant/lipm_plant.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/robot/hip_flywheel.h"

namespace stagger::sim {

LipmParameters lipm_parameters(const Robot& robot) {
  const BipedDescription& d = robot.description;
  LipmParameters p;
  p.mass = robot.model.mass();
  p.com_height = d.walk.com_height_m;
  p.sole = {0.5 * d.feet[0].sole.length, 0.5 * d.feet[0].sole.width};
  p.stance_width = d.walk.stance_width_m;
  p.reach = 2.0 * std::max(d.walk.max_step_length_m, d.walk.max_step_back_m);
  p.hip = hip_flywheel(robot);
  return p;
}

LipmPlant::LipmPlant(const LipmParameters& parameters, double dt)
    : parameters_(parameters),
      omega_(std::sqrt(parameters.gravity / parameters.com_height)),
      dt_(dt),
      lipm_(engine::discretise(omega_, dt)),
      noise_(parameters.seed) {
  truth_.com = {0.0, 0.0, parameters.com_height};
  for (const Side side : {Side::left, Side::right}) {
    const double y = engine::lateral_sign(side) * 0.5 * parameters.stance_width;
    truth_.feet[engine::index(side)].position = {0.0, y, 0.0};
    truth_.foot_load[engine::index(side)] = 0.5 * parameters.mass * parameters.gravity;
  }
  const auto age = static_cast<std::size_t>(std::lround(parameters.delay / dt));
  delayed_.assign(age, truth_);
  measure();
}

void LipmPlant::set_state(const Vec2& com, const Vec2& velocity) {
  truth_.com.head<2>() = com;
  truth_.com_velocity.head<2>() = velocity;
  std::fill(delayed_.begin(), delayed_.end(), truth_);
  measure();
}

Vec2 LipmPlant::dcm() const {
  return truth_.com.head<2>() + truth_.com_velocity.head<2>() / omega_;
}

void LipmPlant::measure() {
  engine::Measurement now = truth_;
  if (parameters_.noise > 0.0) {
    // Independent on CoM and DCM, as the paper has it; the velocity is what those two say.
    for (int axis = 0; axis < 2; ++axis) {
      const double com_error = parameters_.noise * noise_();
      const double dcm_error = parameters_.noise * noise_();
      now.com[axis] += com_error;
      now.com_velocity[axis] += omega_ * (dcm_error - com_error);
    }
  }
  measurement_ = now;
  if (delayed_.empty()) return;
  std::swap(measurement_, delayed_[oldest_]);
  oldest_ = (oldest_ + 1) % delayed_.size();
}

Vec2 LipmPlant::turn_flywheel(const Vec2& wanted_shift) {
  const engine::HipParameters& hip = parameters_.hip;
  Vec2 shift = Vec2::Zero();
  if (hip.torque <= 0.0) return shift;
  const double weight = parameters_.mass * parameters_.gravity;
  for (int axis = 0; axis < 2; ++axis) {
    double torque = std::clamp(wanted_shift[axis] * weight, -hip.torque, hip.torque);
    const double rate = hip_rate_[axis] + torque / hip.inertia * dt_;
    const double angle = hip_angle_[axis] + 0.5 * (hip_rate_[axis] + rate) * dt_;
    // At a stop the motor can push no farther.
    const bool at_stop =
        (angle > hip.angle && torque > 0.0) || (angle < -hip.angle && torque < 0.0);
    if (at_stop || std::abs(rate) > hip.rate) torque = 0.0;
    shift[axis] = torque / weight;
    const double acceleration = torque / hip.inertia;
    hip_angle_[axis] += (hip_rate_[axis] + 0.5 * acceleration * dt_) * dt_;
    hip_rate_[axis] += acceleration * dt_;
  }
  return shift;
}

void LipmPlant::step(const engine::WalkingTargets& targets, std::span<const AppliedForce> forces) {
  if (released_) return;
  auto& feet = truth_.feet;
  const Side support = targets.support_side;
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
  const engine::ConvexPolygon polygon =
      single ? engine::support_polygon(parameters_.sole, feet[engine::index(support)])
             : engine::support_polygon(parameters_.sole, feet[0], feet[1]);
  const Vec2 zmp = polygon.clamp(targets.zmp_command);

  Vec3 force = Vec3::Zero();
  for (const AppliedForce& applied : forces) force += applied.force;
  // A constant force is a shift of the ZMP: w^2 (c - p) + F/m = w^2 (c - (p - F/(m w^2))).
  hip_shift_ = turn_flywheel(targets.zmp_shift);
  const Vec2 effective = zmp + hip_shift_ - force.head<2>() / (parameters_.mass * omega_ * omega_);
  Eigen::Matrix2d state;
  state.row(0) = truth_.com.head<2>();
  state.row(1) = dcm();
  state = (lipm_.a * state + lipm_.b * effective.transpose()).eval();
  truth_.com.head<2>() = state.row(0);
  truth_.com_velocity.head<2>() = omega_ * (state.row(1) - state.row(0)).transpose();
  truth_.zmp = zmp;

  // The weight on each foot follows from where the ZMP is between the feet.
  const Vec2 between = (feet[1].position - feet[0].position).head<2>();
  const double along = (zmp - feet[0].position.head<2>()).dot(between);
  // Feet in one place share the load.
  const double apart = between.squaredNorm();
  const double right = apart > 0.0 ? std::clamp(along / apart, 0.0, 1.0) : 0.5;
  const double weight = parameters_.mass * parameters_.gravity;
  if (single) {
    // A foot without mass is down when its plan says so: by the end of this tick. Its share of the
    // load is a matter of convention.
    const std::size_t swing = engine::index(engine::other(support));
    const bool landed = targets.phase_time + dt_ >= targets.t_ss - 1e-9;
    truth_.foot_load[swing] = landed ? 0.5 * weight : 0.0;
    truth_.foot_load[engine::index(support)] = weight - truth_.foot_load[swing];
  } else {
    truth_.foot_load = {(1.0 - right) * weight, right * weight};
  }
  measure();
}

void LipmPlant::describe(Frame& frame) const {
  frame.com = truth_.com;
  frame.com_velocity = truth_.com_velocity;
  frame.dcm = dcm();
  frame.zmp = truth_.zmp;
  const double weight = parameters_.mass * parameters_.gravity;
  const engine::HipParameters& hip = parameters_.hip;
  // The hips lean about +y and about -x.
  frame.angular_momentum = hip.inertia * Vec3(-hip_rate_.y(), hip_rate_.x(), 0.0);
  const Vec2 horizontal =
      weight / parameters_.com_height * (truth_.com.head<2>() - truth_.zmp - hip_shift_);
  frame.ground_forces[0] = {Vec3(truth_.zmp.x(), truth_.zmp.y(), 0.0),
                            Vec3(horizontal.x(), horizontal.y(), weight)};
  frame.ground_force_count = 1;
  frame.base_position = truth_.com;
  frame.base_orientation = Eigen::Quaterniond::Identity();
  frame.feet = truth_.feet;
  frame.foot_load = truth_.foot_load;
  frame.joint_count = 0;
}

std::string LipmPlant::fall_reason() const {
  double distance = std::numeric_limits<double>::infinity();
  for (const FootPose& foot : truth_.feet) {
    distance = std::min(distance, (dcm() - foot.position.head<2>()).norm());
  }
  // Written so that a NaN is a fall too.
  if (distance <= parameters_.reach) return {};
  return "the DCM is out of reach of any step";
}

void LipmPlant::mix_state(StateHash& hash) const {
  for (int axis = 0; axis < 2; ++axis) {
    hash.mix(truth_.com[axis]);
    hash.mix(truth_.com_velocity[axis]);
    hash.mix(truth_.zmp[axis]);
    hash.mix(hip_angle_[axis]);
    for (const FootPose& foot : truth_.feet) hash.mix(foot.position[axis]);
  }
}

}  // namespace stagger::sim
