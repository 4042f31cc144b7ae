// Random models and states: a test that passes on these does not rest on a robot's symmetries.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "sim/robot/robot_model.h"

namespace stagger::sim {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [-1, 1).
  double number() { return distribution_(engine_); }
  Vec3 vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }
  Eigen::VectorXd vector(Eigen::Index size) {
    Eigen::VectorXd result(size);
    for (double& x : result) x = number();
    return result;
  }
  Eigen::Quaterniond rotation() {
    const Eigen::Vector4d raw = vector(4);
    return Eigen::Quaterniond(raw).normalized();
  }

  /// A tree of bodies with skewed axes and full inertia tensors; nothing limits its joints.
  RobotModel model(int bodies) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    RobotModel model;
    for (int i = 0; i < bodies; ++i) {
      Body body;
      body.name = "body" + std::to_string(i);
      body.parent = i == 0 ? -1 : static_cast<int>(std::floor(0.5 * (number() + 1.0) * i));
      body.joint = i == 0 ? "" : "joint" + std::to_string(i);
      body.placement.linear() = rotation().toRotationMatrix();
      body.placement.translation() = 0.3 * vector();
      body.axis = vector().normalized();
      body.lower = -infinity;
      body.upper = infinity;
      body.effort = infinity;
      body.velocity = infinity;
      body.mass = 2.0 + number();
      body.com = 0.2 * vector();
      const Eigen::Matrix3d turn = rotation().toRotationMatrix();
      const Vec3 extent = Vec3(0.3, 0.2, 0.1) + 0.05 * vector();  // of a box
      const Vec3 squares = extent.cwiseAbs2();
      const Vec3 moments = body.mass / 12.0 * (Vec3::Constant(squares.sum()) - squares);
      body.inertia = turn * moments.asDiagonal() * turn.transpose();
      model.bodies.push_back(body);
      model.links[body.name] = {i, Eigen::Isometry3d::Identity(), body.com, body.mass};
    }
    return model;
  }

  /// Up to 100 m from the origin, at some metres a second.
  RobotState state(const RobotModel& model) {
    const auto joints = static_cast<Eigen::Index>(model.joint_count());
    RobotState state;
    state.base_position = 100.0 * vector() + Vec3(0.0, 0.0, 200.0);
    state.base_orientation = rotation();
    state.base_velocity = 3.0 * vector();
    state.base_angular_velocity = 3.0 * vector();
    state.q = 2.0 * vector(joints);
    state.qd = 5.0 * vector(joints);
    return state;
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> distribution_{-1.0, 1.0};
};

/// nu of RigidBody.
inline Eigen::VectorXd generalised_velocity(const RobotState& state) {
  Eigen::VectorXd nu(6 + state.qd.size());
  nu << state.base_velocity, state.base_angular_velocity, state.qd;
  return nu;
}

/// The state after the time h at accelerations nudot, to second order in h.
inline RobotState moved(const RobotState& state, const Eigen::VectorXd& nudot, double h) {
  RobotState next = state;
  next.base_position += h * state.base_velocity + 0.5 * h * h * nudot.head<3>();
  const Vec3 turn = h * state.base_angular_velocity + 0.5 * h * h * nudot.segment<3>(3);
  if (turn.norm() > 0.0) {
    next.base_orientation = Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized())) *
                            state.base_orientation;
  }
  next.base_velocity += h * nudot.head<3>();
  next.base_angular_velocity += h * nudot.segment<3>(3);
  next.q += h * state.qd + 0.5 * h * h * nudot.tail(state.q.size());
  next.qd += h * nudot.tail(state.q.size());
  return next;
}

}  // namespace stagger::sim
