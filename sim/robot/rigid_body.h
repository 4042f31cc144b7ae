// Floating-base dynamics of a RobotModel: mass matrix, bias forces, Jacobians.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "sim/robot/robot_model.h"

namespace stagger::sim {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using Matrix3X = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// The generalised velocity is nu = [velocity of the base body's origin, angular velocity of the
/// base, joint velocities], the first two in world axes; nv = 6 + joints. Six-vectors and Jacobian
/// rows are (linear, angular), world axes. With tau the joint torques and f forces on the bodies,
///   mass_matrix * nudot + bias = S^T tau + sum J^T f,   S = [0 I].
/// Composite-rigid-body and recursive Newton-Euler algorithms (Featherstone, Rigid Body Dynamics
/// Algorithms, 2008, tables 5.1 and 6.2) in world axes about the base's origin, so that nothing is
/// lost far from the world's origin. No heap allocation after construction.
class RigidBody {
 public:
  explicit RigidBody(const RobotModel& model);

  /// Everything below is about this state. `gravity` points down [m/s^2].
  void update(const RobotState& state, double gravity = 9.81);

  int nv() const { return nv_; }
  double mass() const { return mass_; }  ///< [kg]

  const Eigen::MatrixXd& mass_matrix() const { return mass_matrix_; }
  /// C(nu) nu + gravity.
  const Eigen::VectorXd& bias() const { return bias_; }

  Vec3 com() const { return base_position_ + com_; }
  const Vec3& com_velocity() const { return com_velocity_; }
  /// com_velocity = com_jacobian * nu; 3 x nv.
  const Matrix3X& com_jacobian() const { return com_jacobian_; }
  /// Acceleration of the CoM at nudot = 0 [m/s^2].
  const Vec3& com_bias_acceleration() const { return com_bias_acceleration_; }

  /// Angular momentum about the CoM = angular_momentum_matrix * nu; 3 x nv.
  const Matrix3X& angular_momentum_matrix() const { return angular_momentum_matrix_; }
  /// Its rate at nudot = 0 [N m].
  const Vec3& angular_momentum_bias() const { return angular_momentum_bias_; }

  Eigen::Isometry3d pose(int body) const;
  const Eigen::Matrix3d& rotation(int body) const { return links_[body].rotation; }
  /// Origin of the body's frame, world [m].
  Vec3 position(int body) const { return base_position_ + links_[body].origin; }

  /// Velocity of the point of that body that is now at `point` (world); (linear, angular).
  Vec6 velocity(int body, const Vec3& point) const;
  /// Jacobian of that velocity: writes all 6 x nv entries of `out`.
  void jacobian(int body, const Vec3& point, Eigen::Ref<Matrix6X> out) const;
  /// Jdot * nu: acceleration (classical) of that point at nudot = 0; (linear, angular).
  Vec6 bias_acceleration(int body, const Vec3& point) const;

 private:
  // All vectors in world axes; positions and moments are about the base's origin.
  struct Link {
    // Constants of the model.
    int parent = -1;
    Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
    Vec3 axis_local = Vec3::Zero();
    double mass = 0.0;
    Vec3 com_local = Vec3::Zero();
    Eigen::Matrix3d inertia_local = Eigen::Matrix3d::Zero();
    // State.
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Vec3 origin = Vec3::Zero();
    Vec3 com = Vec3::Zero();
    Vec3 axis = Vec3::Zero();         // of the joint: angular part of the motion subspace
    Vec3 axis_moment = Vec3::Zero();  // origin x axis: its linear part
    Vec3 velocity = Vec3::Zero();     // of the body's point at the base's origin
    Vec3 omega = Vec3::Zero();
    Vec3 acceleration = Vec3::Zero();  // spatial, at nudot = 0, without gravity
    Vec3 alpha = Vec3::Zero();
    // Of the subtree that starts here.
    double subtree_mass = 0.0;
    Vec3 subtree_moment = Vec3::Zero();                         // mass * com
    Eigen::Matrix3d subtree_inertia = Eigen::Matrix3d::Zero();  // about the base's origin
    Vec3 force = Vec3::Zero();
    Vec3 moment = Vec3::Zero();
  };

  void place_and_move(const RobotState& state);
  void collect_forces(double gravity);
  void fill_mass_matrix();
  void derive_centroidal(double gravity);

  std::vector<Link> links_;
  int nv_ = 0;
  double mass_ = 0.0;
  Vec3 base_position_ = Vec3::Zero();
  Vec3 com_ = Vec3::Zero();  // about the base's origin
  Vec3 com_velocity_ = Vec3::Zero();
  Vec3 com_bias_acceleration_ = Vec3::Zero();
  Vec3 angular_momentum_bias_ = Vec3::Zero();
  Eigen::MatrixXd mass_matrix_;
  Eigen::VectorXd bias_;
  Matrix3X com_jacobian_;
  Matrix3X angular_momentum_matrix_;
};

}  // namespace stagger::sim
