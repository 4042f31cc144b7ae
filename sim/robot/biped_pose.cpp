#include "sim/robot/biped_pose.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "sim/robot/rigid_body.h"

namespace stagger::sim {
namespace {

using engine::Side;

constexpr double wanted_leg_share = 0.96;
constexpr double least_leg_share = 0.80;
/// Kept free of every joint limit, where the range allows it [rad].
constexpr double limit_margin = 0.02;
constexpr double damping = 1e-4;
constexpr double greatest_turn = 0.2;  // of a joint, in one iteration [rad]
constexpr int most_iterations = 400;
/// Error of a sole's pose that counts as none [m], [rad].
constexpr double settled = 1e-9;
constexpr double near_enough = 1e-6;
/// Soles side by side are at least this share of the leg's length apart.
constexpr double least_gap_share = 0.06;

class Poser {
 public:
  Poser(const Robot& robot, const Legs& legs) : robot_(robot), legs_(legs), body_(robot.model) {
    const auto joints = static_cast<Eigen::Index>(robot.model.joint_count());
    state_.q = Eigen::VectorXd::Zero(joints);
    state_.qd = Eigen::VectorXd::Zero(joints);
    state_.base_orientation = Eigen::Quaterniond(legs.axes.transpose());
    jacobian_.resize(6, body_.nv());
    for (const Side side : {Side::left, Side::right}) {
      for (const LegJoint& joint : legs.leg[index(side)].joints) {
        columns_[index(side)].push_back(robot.model.joint_index(joint.name));
      }
    }
    measure_zero_pose();
  }

  StandingPose run() {
    for (double share = wanted_leg_share; share >= least_leg_share; share -= 0.02) {
      for (const double bend : {0.5, 0.25, 1.0, -0.5, -1.0, 0.0}) {
        if (stand(share, bend)) return result(share);
      }
    }
    throw CannotWalk(
        "no pose within its joint limits has both soles flat on the ground under an upright torso");
  }

 private:
  void update() { body_.update(state_); }
  Eigen::Isometry3d sole(Side side) const {
    return body_.pose(robot_.foot_body(side)) * robot_.sole_in_body(side);
  }
  Vec3 in_world(const Vec3& in_root) const { return legs_.axes.transpose() * in_root; }

  void measure_zero_pose() {
    update();
    for (const Side side : {Side::left, Side::right}) {
      const Leg& leg = legs_.leg[index(side)];
      hip_[index(side)] = in_world(leg.hip);
      ankle_in_sole_[index(side)] = sole(side).inverse() * in_world(leg.ankle);
    }
    const double length = legs_.leg[0].length();
    const double width =
        std::max(robot_.description.feet[0].sole.width, robot_.description.feet[1].sole.width);
    const double apart = sole(Side::left).translation().y() - sole(Side::right).translation().y();
    stance_width_ = std::clamp(apart, width + least_gap_share * length,
                               std::max(0.6 * length, width + least_gap_share * length));
  }

  /// Sets the joints to a start from which the search does not end in a straight leg: the knee bent
  /// by `bend`, hip and ankle pitch by half of it the other way.
  void bend_legs(double bend) {
    state_.q.setZero();
    for (const Leg& leg : legs_.leg) {
      for (const LegJoint& joint : leg.joints) {
        const double sign = joint.axis.y() > 0.0 ? 1.0 : -1.0;
        double& q = state_.q[robot_.model.joint_index(joint.name)];
        if (joint.role == LegRole::knee) q = sign * bend;
        if (joint.role == LegRole::hip_pitch || joint.role == LegRole::ankle_pitch) {
          q = -0.5 * sign * bend;
        }
      }
    }
    for (Eigen::Index j = 0; j < state_.q.size(); ++j) state_.q[j] = clamped(j, state_.q[j]);
  }

  double clamped(Eigen::Index joint, double q) const {
    const Body& body = robot_.model.bodies[static_cast<std::size_t>(joint) + 1];
    const double margin = std::min(limit_margin, 0.1 * (body.upper - body.lower));
    return std::clamp(q, body.lower + margin, body.upper - margin);
  }

  /// Both legs at that share of their length, CoM over the soles; false when there is no such pose.
  bool stand(double share, double bend) {
    bend_legs(bend);
    double ahead = 0.0;  // of the soles' centres from where the hips are
    bool first = true;
    for (int pass = 0; pass < 30; ++pass) {
      // At first the ankles are right below the hips.
      for (const Side side : {Side::left, Side::right}) {
        if (first) ahead -= 0.5 * ankle_in_sole_[index(side)].x();
      }
      first = false;
      bool reached = true;
      for (const Side side : {Side::left, Side::right}) {
        const auto target = target_of(side, share, ahead);
        reached = target && reach(side, *target) && reached;
      }
      if (!reached) return false;
      update();
      const double off = body_.com().x() - 0.5 * (sole(Side::left).translation().x() +
                                                  sole(Side::right).translation().x());
      if (std::abs(off) < 1e-7) return knees_ahead(bend);
      ahead += off;
    }
    return false;
  }

  std::optional<Vec3> target_of(Side side, double share, double ahead) const {
    const Vec3& hip = hip_[index(side)];
    const Vec3& ankle = ankle_in_sole_[index(side)];
    const double middle = 0.5 * (hip_[0].y() + hip_[1].y());
    Vec3 target;
    target.x() = 0.5 * (hip_[0].x() + hip_[1].x()) + ahead;
    target.y() = middle + 0.5 * lateral_sign(side) * stance_width_;
    if (!legs_.leg[index(side)].has(LegRole::ankle_roll)) {
      // It cannot be chosen.
      target.y() = hip.y() - ankle.y();
    }
    const Leg& leg = legs_.leg[index(side)];
    const double dx = target.x() + ankle.x() - hip.x();
    const double dy = target.y() + ankle.y() - hip.y();
    const double reach = share * leg.length();
    const double square = reach * reach - dx * dx - dy * dy;
    if (!(square > 0.25 * reach * reach)) return std::nullopt;
    target.z() = std::max(hip_[0].z(), hip_[1].z()) - std::sqrt(square) - ankle.z();
    if (side == Side::right) target.z() = height_of_left(share, ahead).value_or(target.z());
    return target;
  }

  /// Both soles are at one height: the left leg tells it.
  std::optional<double> height_of_left(double share, double ahead) const {
    const auto left = target_of(Side::left, share, ahead);
    return left ? std::optional<double>(left->z()) : std::nullopt;
  }

  /// Error of the sole's pose, in the rows that this leg is able to choose.
  Eigen::VectorXd error_of(Side side, const Vec3& target, std::vector<Eigen::Index>& rows) const {
    const Leg& leg = legs_.leg[index(side)];
    const Eigen::Isometry3d now = sole(side);
    const Eigen::AngleAxisd turn(now.linear().transpose());
    Vec6 error;
    error.head<3>() = target - now.translation();
    error.tail<3>() = turn.angle() * turn.axis();
    rows = {0, 2, 3, 4};
    if (leg.has(LegRole::ankle_roll)) rows.push_back(1);
    if (leg.has(LegRole::hip_yaw) || leg.has(LegRole::ankle_yaw)) rows.push_back(5);
    std::sort(rows.begin(), rows.end());
    return error(rows);
  }

  bool reach(Side side, const Vec3& target) {
    const std::vector<int>& columns = columns_[index(side)];
    const auto n = static_cast<Eigen::Index>(columns.size());
    std::vector<Eigen::Index> rows;
    double left_over = 0.0;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      update();
      const Eigen::VectorXd error = error_of(side, target, rows);
      left_over = error.cwiseAbs().maxCoeff();
      if (left_over < settled) return true;
      body_.jacobian(robot_.foot_body(side), sole(side).translation(), jacobian_);
      Eigen::MatrixXd j(static_cast<Eigen::Index>(rows.size()), n);
      for (Eigen::Index c = 0; c < n; ++c) {
        j.col(c) = jacobian_.col(6 + columns[static_cast<std::size_t>(c)])(rows);
      }
      move(columns, j, error);
    }
    return left_over < near_enough;
  }

  /// One step of damped least squares; joints at a limit that they would be pushed through are left
  /// out of it, and it is solved anew.
  void move(const std::vector<int>& columns, Eigen::MatrixXd j, const Eigen::VectorXd& error) {
    for (std::size_t round = 0; round <= columns.size(); ++round) {
      Eigen::MatrixXd square = j * j.transpose();
      square.diagonal().array() += damping * std::min(1.0, error.norm());
      Eigen::VectorXd turn = j.transpose() * square.ldlt().solve(error);
      const double most = turn.cwiseAbs().maxCoeff();
      if (most > greatest_turn) turn *= greatest_turn / most;
      bool blocked = false;
      for (Eigen::Index c = 0; c < j.cols(); ++c) {
        const int joint = columns[static_cast<std::size_t>(c)];
        const double wanted = state_.q[joint] + turn[c];
        if (turn[c] != 0.0 && state_.q[joint] == clamped(joint, wanted)) {
          j.col(c).setZero();
          blocked = true;
        }
      }
      if (blocked) continue;
      for (Eigen::Index c = 0; c < j.cols(); ++c) {
        const int joint = columns[static_cast<std::size_t>(c)];
        state_.q[joint] = clamped(joint, state_.q[joint] + turn[c]);
      }
      return;
    }
  }

  /// Knees bend to the front, unless the start meant the other way.
  bool knees_ahead(double bend) const {
    for (const Side side : {Side::left, Side::right}) {
      const Leg& leg = legs_.leg[index(side)];
      int knee = 0;
      for (const LegJoint& joint : leg.joints) {
        if (joint.role == LegRole::knee) knee = robot_.model.joint_index(joint.name) + 1;
      }
      const Vec3 hip = hip_[index(side)];
      const Vec3 ankle = sole(side) * ankle_in_sole_[index(side)];
      const Vec3 to_knee = body_.position(knee) - hip;
      const Vec3 line = (ankle - hip).normalized();
      if ((to_knee - line.dot(to_knee) * line).x() * bend < 0.0) return false;
    }
    return true;
  }

  StandingPose result(double share) const {
    StandingPose pose;
    for (std::size_t i = 0; i < 2; ++i) {
      for (const int joint : columns_[i]) {
        const Body& body = robot_.model.bodies[static_cast<std::size_t>(joint) + 1];
        const double rounded = std::round(state_.q[joint] * 1e6) / 1e6;
        pose.joints[body.joint] = std::clamp(rounded, body.lower, body.upper);
      }
    }
    pose.leg_share = share;
    pose.com_height = body_.com().z() - 0.5 * (sole(Side::left).translation().z() +
                                               sole(Side::right).translation().z());
    pose.stance_width = sole(Side::left).translation().y() - sole(Side::right).translation().y();
    return pose;
  }

  const Robot& robot_;
  const Legs& legs_;
  RigidBody body_;
  RobotState state_;
  Matrix6X jacobian_;
  engine::PerFoot<std::vector<int>> columns_;  // joints of each leg
  engine::PerFoot<Vec3> hip_;                  // world, the root's origin at 0
  engine::PerFoot<Vec3> ankle_in_sole_;
  double stance_width_ = 0.0;
};

}  // namespace

StandingPose find_standing_pose(const Robot& robot, const Legs& legs) {
  return Poser(robot, legs).run();
}

}  // namespace stagger::sim
