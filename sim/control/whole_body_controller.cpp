#include "sim/control/whole_body_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/plant/motor_limits.h"

namespace stagger::sim {
namespace {

using engine::Vec2;

/// Of the CoM (3), the momentum (2), the torso (3) and the feet (6 each).
constexpr Eigen::Index most_task_rows = 20;

/// Rotation vector that takes `from` to `to`, world axes [rad].
Vec3 rotation_error(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  const Eigen::AngleAxisd turn(to * from.transpose());
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d yaw_rotation(double yaw) {
  return Eigen::AngleAxisd(yaw, Vec3::UnitZ()).toRotationMatrix();
}

void shorten_to(double most, Eigen::Ref<Vec3> vector) {
  const double size = vector.norm();
  if (size > most) vector *= most / size;
}

}  // namespace

WholeBodyController::WholeBodyController(const Robot& robot, const WholeBodyGains& gains)
    : gains_(gains),
      joints_(robot.model.bodies.begin() + 1, robot.model.bodies.end()),
      nv_(6 + static_cast<Eigen::Index>(robot.model.joint_count())) {
  for (const engine::Side side : {engine::Side::left, engine::Side::right}) {
    Foot& foot = feet_[engine::index(side)];
    foot.body = robot.foot_body(side);
    legs_[engine::index(side)] = leg_geometry(robot, side);
    foot.sole = robot.sole_in_body(side);
    const SoleDescription& sole = robot.description.feet[engine::index(side)].sole;
    const double x = 0.5 * sole.length - gains.sole_margin;
    const double y = 0.5 * sole.width - gains.sole_margin;
    foot.corners = {foot.sole * Vec3(x, y, 0.0), foot.sole * Vec3(x, -y, 0.0),
                    foot.sole * Vec3(-x, y, 0.0), foot.sole * Vec3(-x, -y, 0.0)};
  }
  // A knee that has gone past straight cannot be bent again by what shortens the leg: it is braked
  // before, even where its range goes on.
  for (const LegGeometry& leg : legs_) {
    if (leg.knee_joint < 0) continue;
    Body& knee = joints_[static_cast<std::size_t>(leg.knee_joint)];
    if (leg.knee_way > 0.0) {
      knee.lower = std::max(knee.lower, leg.straight_knee);
    } else {
      knee.upper = std::min(knee.upper, leg.straight_knee);
    }
  }
  set_gains(gains);
  torso_body_ = robot.model.links.at(robot.description.torso).body;
  torso_in_body_ = robot.torso_in_body();
  jacobian_.resize(6, nv_);
  task_rows_.resize(most_task_rows, nv_);
  task_values_.resize(most_task_rows);
  torque_ = Eigen::VectorXd::Zero(nv_ - 6);
}

void WholeBodyController::set_gains(const WholeBodyGains& gains) {
  gains_ = gains;
  limit_weights_.assign(joints_.size(), gains.limit_weight);
  for (const LegGeometry& leg : legs_) {
    for (const int joint : leg.ankle_joints) {
      limit_weights_[static_cast<std::size_t>(joint)] = gains.ankle_limit_weight;
    }
  }
}

void WholeBodyController::add_task(double weight, const Rows& jacobian,
                                   const Eigen::Ref<const Eigen::VectorXd>& value) {
  const double root = std::sqrt(weight);
  task_rows_.middleRows(task_count_, jacobian.rows()) = root * jacobian;
  task_values_.segment(task_count_, jacobian.rows()) = root * value;
  task_count_ += jacobian.rows();
}

void WholeBodyController::sum_up_tasks() {
  const auto rows = task_rows_.topRows(task_count_);
  problem_.h.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  problem_.g.head(nv_).noalias() -= rows.transpose() * task_values_.head(task_count_);
}

void WholeBodyController::add_com_task(const RigidBody& body,
                                       const engine::WalkingTargets& targets) {
  const double omega_squared = gravity_ / targets.com_height;
  const Vec3 com = body.com();
  const double ground = targets.feet[engine::index(targets.support_side)].position.z();
  // Eq. (2): the ZMP that the engine wants is an acceleration of the CoM. The hip strategy's torque
  // acts like a ZMP farther out.
  Vec3 wanted;
  wanted.head<2>() = omega_squared * (com.head<2>() - targets.zmp_command - targets.zmp_shift);
  const double height = std::min(ground + targets.com_height, reachable_com_height(body, targets));
  wanted.z() = gains_.height_stiffness * (height - com.z()) -
               gains_.height_damping * body.com_velocity().z();
  wanted -= body.com_bias_acceleration();
  add_task(gains_.com_weight, body.com_jacobian().topRows(2), wanted.head<2>());
  add_task(gains_.height_weight, body.com_jacobian().bottomRows(1), wanted.tail<1>());
}

double WholeBodyController::reachable_com_height(const RigidBody& body,
                                                 const engine::WalkingTargets& targets) const {
  const Vec3 com = body.com();
  const Vec2 velocity = body.com_velocity().head<2>();
  // Where the CoM will be at touchdown: eq. (3) with the ZMP as it is now.
  const double omega = std::sqrt(gravity_ / targets.com_height);
  const bool single = targets.state == engine::WalkingState::single_support;
  const double left = single ? std::max(targets.t_ss - targets.phase_time, 0.0) : 0.0;
  const Vec2 way = (std::cosh(omega * left) - 1.0) * (com.head<2>() - targets.zmp_command) +
                   std::sinh(omega * left) / omega * velocity;
  double height = std::numeric_limits<double>::infinity();
  for (const engine::Side side : {engine::Side::left, engine::Side::right}) {
    const std::size_t i = engine::index(side);
    const LegGeometry& leg = legs_[i];
    if (leg.length <= 0.0) continue;
    const Vec3 hip = body.position(leg.hip_body);
    const Vec3 ankle = body.position(leg.ankle_body);
    const Vec3 sole = body.pose(feet_[i].body) * feet_[i].sole.translation();
    Vec3 end = ankle;
    if (!targets.feet[i].in_contact) {
      end.head<2>() += targets.adjusted_step.position - sole.head<2>();
      end.z() =
          ankle.z() - sole.z() + targets.feet[engine::index(targets.support_side)].position.z();
    }
    const double longest = gains_.leg_stretch * leg.length;
    const auto limit = [&](const Vec2& apart, double end_z) {
      const double rest = longest * longest - apart.squaredNorm();
      height = std::min(
          height, end_z + std::sqrt(std::max(rest, 0.25 * longest * longest)) + com.z() - hip.z());
    };
    if (targets.feet[i].in_contact) limit((hip - ankle).head<2>(), ankle.z());
    limit(hip.head<2>() + way - end.head<2>(), end.z());
  }
  return height;
}

void WholeBodyController::add_joint_limit_tasks(const RobotState& state) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    const Body& joint = joints_[j];
    for (const double way : {1.0, -1.0}) {
      const double end = way > 0.0 ? joint.upper : joint.lower;
      if (!std::isfinite(end)) continue;
      // The greatest speed from which it can still stop before the end of its range.
      const double room = way * (end - state.q[i]) - gains_.limit_margin;
      const double most = std::sqrt(2.0 * gains_.limit_braking * std::max(room, 0.0));
      const double speed = way * state.qd[i];
      const double excess = speed - most;
      if (excess <= 0.0 && room > 0.0) continue;
      const double braking = room > 0.0 ? gains_.limit_braking : -gains_.limit_return * room;
      const double wanted = -way * (braking + gains_.limit_damping * excess);
      const Eigen::Index x = 6 + i;
      problem_.h(x, x) += limit_weights_[j];
      problem_.g[x] -= limit_weights_[j] * wanted;
    }
  }
}

void WholeBodyController::add_momentum_task(const RigidBody& body,
                                            const engine::WalkingTargets& targets) {
  if (targets.zmp_shift.isZero()) return;
  const double weight = body.mass() * gravity_;
  const Vec2 wanted = weight * Vec2(-targets.zmp_shift.y(), targets.zmp_shift.x()) -
                      body.angular_momentum_bias().head<2>();
  add_task(gains_.momentum_weight, body.angular_momentum_matrix().topRows(2), wanted);
}

void WholeBodyController::add_torso_task(const RigidBody& body,
                                         const engine::WalkingTargets& targets) {
  const Vec3 point = body.position(torso_body_);
  const Eigen::Matrix3d rotation = body.rotation(torso_body_) * torso_in_body_;
  const Vec3 omega = body.velocity(torso_body_, point).tail<3>();
  const Eigen::Matrix3d heading = yaw_rotation(targets.heading);
  // The hip strategy's lean, about the heading's y and -x axes.
  const auto leaning = [&](const Vec2& lean) -> Vec3 {
    return heading * Vec3(-lean.y(), lean.x(), 0.0);
  };
  const Vec3 lean = leaning(targets.hip_angle);
  const Eigen::Matrix3d goal =
      lean.isZero() ? heading
                    : Eigen::Matrix3d(Eigen::AngleAxisd(lean.norm(), lean.normalized()) * heading);
  const Vec3 wanted_omega = leaning(targets.hip_rate) + Vec3(0.0, 0.0, targets.heading_velocity);
  body.jacobian(torso_body_, point, jacobian_);
  const Vec3 wanted = leaning(targets.hip_acceleration) +
                      gains_.torso_stiffness * rotation_error(rotation, goal) +
                      gains_.torso_damping * (wanted_omega - omega) -
                      body.bias_acceleration(torso_body_, point).tail<3>();
  add_task(gains_.torso_weight, jacobian_.bottomRows(3), wanted);
}

double WholeBodyController::ankle_freedom(const LegGeometry& leg, const RobotState& state,
                                          const Vec3& turn) const {
  constexpr double least = 0.01;
  double freedom = 1.0;
  for (const int joint : leg.ankle_joints) {
    const Body& body = joints_[static_cast<std::size_t>(joint)];
    const double q = state.q[joint];
    // A foot at an end is turned back as soon as it should: h1_2's, tilted by a long step behind
    // it, else stayed so while the leg came forward, and landed on its heel in mid-swing.
    constexpr double eager = 4.0;  // it is held again from 0.025 rad on
    const double way = eager * jacobian_.col(6 + joint).tail<3>().dot(turn);
    const double room =
        std::min(q - body.lower + std::max(way, 0.0), body.upper - q + std::max(-way, 0.0));
    freedom = std::min(freedom, room / gains_.limit_margin - 1.0);
  }
  return std::max(freedom, least);
}

void WholeBodyController::add_foot_task(const RigidBody& body, const Foot& foot,
                                        const engine::FootTarget& target, const LegGeometry& leg,
                                        const RobotState& state, const Eigen::Quaterniond& ground) {
  const Vec3 point = body.pose(foot.body) * foot.sole.translation();
  const Vec6 velocity = body.velocity(foot.body, point);
  body.jacobian(foot.body, point, jacobian_);
  Vec6 wanted;
  double weight = 0.0;
  Vec3 turn = Vec3::Zero();
  if (target.in_contact) {
    // A standing foot is held by its contact: all that is asked of it is not to move.
    wanted = -gains_.stance_damping * velocity;
    weight = gains_.stance_weight;
  } else {
    turn = rotation_error(body.rotation(foot.body) * foot.sole.linear(),
                          ground * yaw_rotation(target.yaw));
    wanted.head<3>() = target.acceleration + gains_.swing_stiffness * (target.position - point) +
                       gains_.swing_damping * (target.velocity - velocity.head<3>());
    shorten_to(gains_.swing_acceleration_limit, wanted.head<3>());
    wanted.tail<3>() =
        Vec3(0.0, 0.0, target.yaw_acceleration) + gains_.swing_turn_stiffness * turn +
        gains_.swing_turn_damping * (Vec3(0.0, 0.0, target.yaw_velocity) - velocity.tail<3>());
    shorten_to(gains_.swing_turn_acceleration_limit, wanted.tail<3>());
    weight = gains_.swing_weight;
  }
  wanted -= body.bias_acceleration(foot.body, point);
  // But a toe that hangs down is not lifted so: a step that comes late is down the sooner by it.
  const Vec3 lateral = yaw_rotation(target.yaw).col(1);
  turn -= std::min(turn.dot(lateral), 0.0) * lateral;
  // Weights go with the square of a row.
  const double tilt = gains_.angular_length * std::sqrt(ankle_freedom(leg, state, turn));
  const Vec3 scale(tilt, tilt, gains_.angular_length);
  jacobian_.bottomRows<3>() = scale.asDiagonal() * jacobian_.bottomRows<3>();
  wanted.tail<3>() = scale.cwiseProduct(wanted.tail<3>());
  add_task(weight, jacobian_, wanted);
}

void WholeBodyController::find_contacts(const RigidBody& body,
                                        const engine::WalkingTargets& targets) {
  contacts_.clear();
  for (std::size_t i = 0; i < feet_.size(); ++i) {
    if (!targets.feet[i].in_contact) continue;
    const Eigen::Isometry3d pose = body.pose(feet_[i].body);
    for (const Vec3& corner : feet_[i].corners) contacts_.push_back({feet_[i].body, pose * corner});
  }
  contact_jacobian_.resize(3 * static_cast<Eigen::Index>(contacts_.size()), nv_);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    body.jacobian(contacts_[i].body, contacts_[i].point, jacobian_);
    contact_jacobian_.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = jacobian_.topRows(3);
  }
}

void WholeBodyController::add_dynamics(const RigidBody& body) {
  // The base has no motor: M_b nudot + h_b = J_b' f.
  problem_.equality.leftCols(nv_) = body.mass_matrix().topRows(6);
  problem_.equality.rightCols(contact_jacobian_.rows()) =
      -contact_jacobian_.leftCols(6).transpose();
  problem_.equality_value = -body.bias().head(6);
}

void WholeBodyController::add_limits(const RigidBody& body, const RobotState& state) {
  Eigen::Index row = 0;
  problem_.inequality.topRows(5 * static_cast<Eigen::Index>(contacts_.size())).setZero();
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Eigen::Index x = nv_ + 3 * static_cast<Eigen::Index>(i);
    for (const Eigen::Index tangent : {x, x + 1}) {
      for (const double sign : {1.0, -1.0}) {
        problem_.inequality(row, x + 2) = gains_.friction;
        problem_.inequality(row, tangent) = sign;
        problem_.inequality_bound[row++] = 0.0;
      }
    }
    problem_.inequality(row, x + 2) = 1.0;
    problem_.inequality_bound[row++] = gains_.least_normal_force;
  }
  // tau = M_j nudot + h_j - J_j' f within what the motors give at their speed.
  const Eigen::Index joints = nv_ - 6;
  auto upper = problem_.inequality.middleRows(row, joints);
  upper.leftCols(nv_) = -body.mass_matrix().bottomRows(joints);
  upper.rightCols(contact_jacobian_.rows()) = contact_jacobian_.rightCols(joints).transpose();
  problem_.inequality.middleRows(row + joints, joints) = -upper;
  for (Eigen::Index j = 0; j < joints; ++j) {
    const TorqueRange range = available_torque(joints_[static_cast<std::size_t>(j)], state.qd[j]);
    const double bias = body.bias()[6 + j];
    problem_.inequality_bound[row + j] = bias - range.upper;
    problem_.inequality_bound[row + joints + j] = range.lower - bias;
  }
}

const Eigen::VectorXd& WholeBodyController::compute(const RigidBody& body, const RobotState& state,
                                                    const engine::WalkingTargets& targets) {
  find_contacts(body, targets);
  const Eigen::Index forces = contact_jacobian_.rows();
  const Eigen::Index n = nv_ + forces;
  const Eigen::Index joints = nv_ - 6;
  const Eigen::Index limits = 5 * static_cast<Eigen::Index>(contacts_.size()) + 2 * joints;
  problem_.h.setZero(nv_, nv_);
  problem_.h.diagonal().setConstant(gains_.acceleration_regularisation);
  problem_.diagonal.setConstant(forces, gains_.force_regularisation);
  problem_.g.setZero(n);
  task_count_ = 0;
  problem_.equality.resize(6, n);
  problem_.inequality.resize(limits, n);
  problem_.inequality_bound.resize(limits);

  const Vec3 normal(-targets.ground_slope.x(), -targets.ground_slope.y(), 1.0);
  const auto ground = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal);
  add_com_task(body, targets);
  add_momentum_task(body, targets);
  add_torso_task(body, targets);
  for (std::size_t i = 0; i < feet_.size(); ++i) {
    add_foot_task(body, feet_[i], targets.feet[i], legs_[i], state, ground);
  }
  add_joint_limit_tasks(state);
  sum_up_tasks();
  add_dynamics(body);
  add_limits(body, state);

  if (solver_.solve(problem_) != QpStatus::solved) {
    ++failed_solves_;
    torque_ = -gains_.fallback_damping * state.qd;
    return torque_;
  }
  const auto& x = solver_.solution();
  torque_ = body.bias().tail(joints);
  torque_.noalias() += body.mass_matrix().bottomRows(joints) * x.head(nv_);
  torque_.noalias() -= contact_jacobian_.rightCols(joints).transpose() * x.tail(forces);
  return torque_;
}

}  // namespace stagger::sim
