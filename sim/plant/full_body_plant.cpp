#include "sim/plant/full_body_plant.h"

#include <algorithm>
#include <cmath>

#include "sim/robot/dynamic_scale.h"
#include "sim/robot/posture.h"
#include "sim/robot/slope_state.h"

namespace stagger::sim {
namespace {

/// Lower than this share of its walking height the robot counts as fallen.
constexpr double fall_height_share = 0.6;
/// Torso leaning more than this [rad].
constexpr double fall_tilt = 1.0;
/// Damping of the joints of a robot that has gone limp, at 30 kg and 1 m [N m s].
constexpr double limp_damping = 2.0;

/// The posture that it walks in, or the one nearest to it whose soles lie on the slope.
RobotState start_state(const Robot& robot, const Terrain& terrain) {
  if (terrain.normal() == Vec3::UnitZ()) return walking_state(robot);
  return slope_state(robot, terrain.normal());
}

const SenseParameters& valid(const SenseParameters& senses) {
  validate(senses);
  return senses;
}

}  // namespace

FullBodyPlant::FullBodyPlant(std::shared_ptr<const Robot> robot, const PhysicsParameters& physics,
                             const SenseParameters& senses, std::uint64_t seed,
                             const Terrain& terrain, const std::optional<WholeBodyGains>& gains)
    : robot_(std::move(robot)),
      senses_(valid(senses)),
      terrain_(terrain),
      world_(robot_->model, start_state(*robot_, terrain), physics, terrain),
      sensors_(*robot_, senses.sensors, seed, physics.dt, physics.gravity, world_.state()),
      estimator_(*robot_, senses.sensors, physics.dt, physics.gravity, world_.state()),
      body_(robot_->model),
      true_body_(robot_->model),
      controller_(*robot_,
                  gains ? *gains : whole_body_gains(*robot_, senses.control_delay + physics.dt)),
      limp_damping_(limp_damping * dynamic_scale(*robot_).damping()) {
  const auto joints = static_cast<Eigen::Index>(robot_->model.joint_count());
  torque_ = Eigen::VectorXd::Zero(joints);
  torque_ring_.assign(static_cast<std::size_t>(std::lround(senses.control_delay / physics.dt)),
                      torque_);
  body_.update(world_.state(), world_.parameters().gravity);
  true_body_.update(world_.state(), world_.parameters().gravity);
  place_robot(body_, measurement_);
  // Before the first step no contact has been solved: it stands with half its weight on each foot.
  measurement_.zmp = measurement_.com.head<2>();
  measurement_.foot_load.fill(0.5 * body_.mass() * world_.parameters().gravity);
  truth_ = measurement_;
}

void FullBodyPlant::place_robot(const RigidBody& body, engine::Measurement& measurement) const {
  measurement.com = body.com();
  measurement.com_velocity = body.com_velocity();
  for (const Side side : {Side::left, Side::right}) {
    const Eigen::Isometry3d sole = body.pose(robot_->foot_body(side)) * robot_->sole_in_body(side);
    FootPose& foot = measurement.feet[engine::index(side)];
    foot.position = sole.translation();
    foot.yaw = std::atan2(sole.linear()(1, 0), sole.linear()(0, 0));
  }
}

void FullBodyPlant::read_loads() {
  PerFoot<Eigen::Isometry3d> world_to_sole;
  for (const Side side : {Side::left, Side::right}) {
    const Eigen::Isometry3d foot = true_body().pose(robot_->foot_body(side));
    world_to_sole[engine::index(side)] = (foot * robot_->sole_in_body(side)).inverse();
  }
  truth_.foot_load.fill(0.0);
  sole_loads_.fill(SoleLoad());
  double load = 0.0;
  Vec2 moment = Vec2::Zero();
  for (const BulletWorld::Contact& contact : world_.contacts()) {
    if (!contact.with_ground()) continue;
    load += contact.force.z();
    moment += contact.force.z() * contact.point.head<2>();
    for (const Side side : {Side::left, Side::right}) {
      const std::size_t i = engine::index(side);
      if (contact.body != robot_->foot_body(side)) continue;
      truth_.foot_load[i] += contact.force.z();
      const double force = world_to_sole[i].linear().row(2).dot(contact.force);
      sole_loads_[i].force += force;
      sole_loads_[i].cop += force * (world_to_sole[i] * contact.point).head<2>();
    }
  }
  if (load > 0.0) truth_.zmp = moment / load;
  for (SoleLoad& sole : sole_loads_) {
    if (sole.force > 0.0) sole.cop /= sole.force;
  }
}

void FullBodyPlant::sense() {
  const double gravity = world_.parameters().gravity;
  if (senses_.perfect_state) {
    body_.update(world_.state(), gravity);
    place_robot(body_, truth_);
    read_loads();
    measurement_ = truth_;
    return;
  }
  true_body_.update(world_.state(), gravity);
  place_robot(true_body_, truth_);
  read_loads();
  const SensorReadings& readings = sensors_.read(world_.state(), sole_loads_);
  estimator_.update(readings);
  body_.update(estimator_.state(), gravity);
  place_robot(body_, measurement_);
  double load = 0.0;
  Vec2 moment = Vec2::Zero();
  for (const Side side : {Side::left, Side::right}) {
    const std::size_t i = engine::index(side);
    const SoleLoad& sole = readings.soles[i];
    const double force = std::max(sole.force, 0.0);
    const Eigen::Isometry3d foot = body_.pose(robot_->foot_body(side)) * robot_->sole_in_body(side);
    measurement_.foot_load[i] = force;
    load += force;
    moment += force * (foot * Vec3(sole.cop.x(), sole.cop.y(), 0.0)).head<2>();
  }
  if (load > 0.0) measurement_.zmp = moment / load;
}

const Eigen::VectorXd& FullBodyPlant::delayed(const Eigen::VectorXd& torque) {
  if (torque_ring_.empty()) return torque;
  // The motors have held the robot before; they go on so until the first command reaches them.
  if (!commanded_) std::fill(torque_ring_.begin(), torque_ring_.end(), torque);
  commanded_ = true;
  torque_ = torque_ring_[next_torque_];
  torque_ring_[next_torque_] = torque;
  next_torque_ = (next_torque_ + 1) % torque_ring_.size();
  return torque_;
}

void FullBodyPlant::step(const engine::WalkingTargets& targets,
                         std::span<const AppliedForce> forces) {
  if (released_) {
    torque_ = -limp_damping_ * world_.state().qd;
    world_.step(torque_, forces);
  } else {
    world_.step(delayed(controller_.compute(body_, known_state(), targets)), forces);
  }
  sense();
}

void FullBodyPlant::describe(Frame& frame) const {
  const RobotState& state = world_.state();
  const double omega =
      std::sqrt(world_.parameters().gravity / robot_->description.walk.com_height_m);
  frame.com = truth_.com;
  frame.com_velocity = truth_.com_velocity;
  frame.dcm = truth_.com.head<2>() + truth_.com_velocity.head<2>() / omega;
  frame.zmp = truth_.zmp;
  const RigidBody& body = true_body();
  const Matrix3X& momentum = body.angular_momentum_matrix();
  frame.angular_momentum.noalias() = momentum.leftCols<3>() * state.base_velocity;
  frame.angular_momentum.noalias() += momentum.middleCols<3>(3) * state.base_angular_velocity;
  frame.angular_momentum.noalias() += momentum.rightCols(state.qd.size()) * state.qd;
  frame.ground_force_count = 0;
  for (const BulletWorld::Contact& contact : world_.contacts()) {
    if (!contact.with_ground() || frame.ground_force_count == max_contacts) continue;
    frame.ground_forces[frame.ground_force_count++] = {contact.point, contact.force};
  }
  frame.base_position = state.base_position;
  frame.base_orientation = state.base_orientation;
  frame.feet = truth_.feet;
  frame.foot_load = truth_.foot_load;
  frame.joint_count = std::min(robot_->model.joint_count(), max_joints);
  const auto count = static_cast<Eigen::Index>(frame.joint_count);
  std::copy_n(state.q.data(), count, frame.joint_position.begin());
  std::copy_n(state.qd.data(), count, frame.joint_velocity.begin());
  const Eigen::VectorXd& torque = world_.applied_torque();
  if (torque.size() >= count) std::copy_n(torque.data(), count, frame.joint_torque.begin());
}

Vec3 FullBodyPlant::point_of(const AppliedForce& force) const {
  return world_.application_point(force);
}

std::string FullBodyPlant::fall_reason() const {
  const double height = truth_.com.z() - terrain_.height(truth_.com.head<2>());
  if (height < fall_height_share * robot_->description.walk.com_height_m) {
    return "the centre of mass is too low";
  }
  const int torso = robot_->model.links.at(robot_->description.torso).body;
  const Vec3 up = true_body().rotation(torso) * robot_->torso_in_body().col(2);
  if (std::acos(std::clamp(up.z(), -1.0, 1.0)) > fall_tilt) return "the torso leans too far";
  for (const BulletWorld::Contact& contact : world_.contacts()) {
    if (!contact.with_ground()) continue;
    const bool is_foot = contact.body == robot_->foot_body(Side::left) ||
                         contact.body == robot_->foot_body(Side::right);
    if (!is_foot) {
      const auto body = static_cast<std::size_t>(contact.body);
      return robot_->model.bodies[body].name + " touches the ground";
    }
  }
  return {};
}

void FullBodyPlant::mix_state(StateHash& hash) const { world_.mix_state(hash); }

}  // namespace stagger::sim
