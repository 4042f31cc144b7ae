#include "sim/plant/full_body_plant.h"

#include <algorithm>
#include <cmath>

namespace stagger::sim {
namespace {

/// Lower than this share of its walking height the robot counts as fallen.
constexpr double fall_height_share = 0.6;
/// Torso leaning more than this [rad].
constexpr double fall_tilt = 1.0;
/// Damping of the joints of a robot that has gone limp [N m s].
constexpr double limp_damping = 2.0;

PhysicsParameters physics(double dt) {
  PhysicsParameters parameters;
  parameters.dt = dt;
  return parameters;
}

}  // namespace

FullBodyPlant::FullBodyPlant(std::shared_ptr<const Robot> robot, double dt)
    : robot_(std::move(robot)),
      world_(robot_->model, nominal_state(*robot_), physics(dt)),
      body_(robot_->model),
      controller_(*robot_) {
  torque_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(robot_->model.joint_count()));
  measure();
  // Before the first step no contact has been solved: it stands with half its weight on each foot.
  measurement_.zmp = measurement_.com.head<2>();
  measurement_.foot_load.fill(0.5 * body_.mass() * world_.parameters().gravity);
}

void FullBodyPlant::measure() {
  body_.update(world_.state(), world_.parameters().gravity);
  measurement_.com = body_.com();
  measurement_.com_velocity = body_.com_velocity();
  for (const Side side : {Side::left, Side::right}) {
    const Eigen::Isometry3d sole = body_.pose(robot_->foot_body(side)) * robot_->sole_in_body(side);
    FootPose& foot = measurement_.feet[engine::index(side)];
    foot.position = sole.translation();
    foot.yaw = std::atan2(sole.linear()(1, 0), sole.linear()(0, 0));
  }
  measurement_.foot_load.fill(0.0);
  double load = 0.0;
  Vec2 moment = Vec2::Zero();
  for (const BulletWorld::Contact& contact : world_.contacts()) {
    load += contact.force.z();
    moment += contact.force.z() * contact.point.head<2>();
    for (const Side side : {Side::left, Side::right}) {
      if (contact.body == robot_->foot_body(side)) {
        measurement_.foot_load[engine::index(side)] += contact.force.z();
      }
    }
  }
  if (load > 0.0) measurement_.zmp = moment / load;
}

void FullBodyPlant::step(const engine::WalkingTargets& targets,
                         std::span<const AppliedForce> forces) {
  if (released_) {
    torque_ = -limp_damping * world_.state().qd;
  } else {
    torque_ = controller_.compute(body_, world_.state(), targets);
  }
  world_.step(torque_, forces);
  measure();
}

void FullBodyPlant::describe(Frame& frame) const {
  const RobotState& state = world_.state();
  const double omega =
      std::sqrt(world_.parameters().gravity / robot_->description.walk.com_height_m);
  frame.com = measurement_.com;
  frame.com_velocity = measurement_.com_velocity;
  frame.dcm = measurement_.com.head<2>() + measurement_.com_velocity.head<2>() / omega;
  frame.zmp = measurement_.zmp;
  frame.base_position = state.base_position;
  frame.base_orientation = state.base_orientation;
  frame.feet = measurement_.feet;
  frame.foot_load = measurement_.foot_load;
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
  if (measurement_.com.z() < fall_height_share * robot_->description.walk.com_height_m) {
    return "the centre of mass is too low";
  }
  const int torso = robot_->model.links.at(robot_->description.torso).body;
  const Vec3 up = body_.rotation(torso) * robot_->torso_in_body().col(2);
  if (std::acos(std::clamp(up.z(), -1.0, 1.0)) > fall_tilt) return "the torso leans too far";
  for (const BulletWorld::Contact& contact : world_.contacts()) {
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
