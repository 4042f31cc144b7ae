#include "sim/robot/rigid_body.h"

#include <cassert>

namespace stagger::sim {

RigidBody::RigidBody(const RobotModel& model) {
  links_.reserve(model.bodies.size());
  for (const Body& body : model.bodies) {
    Link link;
    link.parent = body.parent;
    link.placement = body.placement;
    link.axis_local = body.axis;
    link.mass = body.mass;
    link.com_local = body.com;
    link.inertia_local = body.inertia;
    links_.push_back(link);
    mass_ += body.mass;
  }
  nv_ = 6 + static_cast<int>(model.joint_count());
  // Joints on different branches do not meet in the mass matrix: those entries stay zero for good.
  mass_matrix_ = Eigen::MatrixXd::Zero(nv_, nv_);
  bias_ = Eigen::VectorXd::Zero(nv_);
  com_jacobian_ = Matrix3X::Zero(3, nv_);
  angular_momentum_matrix_ = Matrix3X::Zero(3, nv_);
}

void RigidBody::update(const RobotState& state, double gravity) {
  assert(state.q.size() == nv_ - 6 && state.qd.size() == nv_ - 6);
  place_and_move(state);
  collect_forces(gravity);
  fill_mass_matrix();
  derive_centroidal(gravity);
}

void RigidBody::place_and_move(const RobotState& state) {
  base_position_ = state.base_position;
  Link& base = links_[0];
  base.rotation = state.base_orientation.toRotationMatrix();
  base.origin.setZero();
  base.velocity = state.base_velocity;
  base.omega = state.base_angular_velocity;
  // nudot holds the acceleration of the base's origin itself; the spatial acceleration is that of
  // whatever point of the base passes through there: less by omega x v.
  base.acceleration = -base.omega.cross(base.velocity);
  base.alpha.setZero();
  for (std::size_t i = 1; i < links_.size(); ++i) {
    Link& link = links_[i];
    const Link& parent = links_[link.parent];
    const double q = state.q[static_cast<Eigen::Index>(i) - 1];
    const double qd = state.qd[static_cast<Eigen::Index>(i) - 1];
    const Eigen::Matrix3d at_zero = parent.rotation * link.placement.linear();
    link.rotation.noalias() = at_zero * Eigen::AngleAxisd(q, link.axis_local).toRotationMatrix();
    link.origin = parent.origin + parent.rotation * link.placement.translation();
    link.axis = at_zero * link.axis_local;
    link.axis_moment = link.origin.cross(link.axis);
    link.omega = parent.omega + qd * link.axis;
    link.velocity = parent.velocity + qd * link.axis_moment;
    link.alpha = parent.alpha + qd * link.omega.cross(link.axis);
    link.acceleration = parent.acceleration +
                        qd * (link.omega.cross(link.axis_moment) + link.velocity.cross(link.axis));
  }
}

void RigidBody::collect_forces(double gravity) {
  const Vec3 lift(0.0, 0.0, gravity);  // weight, as an acceleration of everything upwards
  for (Link& link : links_) {
    link.com = link.origin + link.rotation * link.com_local;
    const Vec3 moment = link.mass * link.com;
    Eigen::Matrix3d inertia;
    inertia.noalias() = (link.rotation * link.inertia_local) * link.rotation.transpose();
    inertia.noalias() -= moment * link.com.transpose();
    inertia.diagonal().array() += moment.dot(link.com);

    const Vec3 acceleration = link.acceleration + lift;
    const Vec3 linear_momentum = link.mass * link.velocity + link.omega.cross(moment);
    const Vec3 angular_momentum = inertia * link.omega + moment.cross(link.velocity);
    link.force =
        link.mass * acceleration + link.alpha.cross(moment) + link.omega.cross(linear_momentum);
    link.moment = inertia * link.alpha + moment.cross(acceleration) +
                  link.omega.cross(angular_momentum) + link.velocity.cross(linear_momentum);
    link.subtree_mass = link.mass;
    link.subtree_moment = moment;
    link.subtree_inertia = inertia;
  }
  for (std::size_t i = links_.size() - 1; i > 0; --i) {
    const Link& link = links_[i];
    Link& parent = links_[link.parent];
    bias_[static_cast<Eigen::Index>(i) + 5] =
        link.axis_moment.dot(link.force) + link.axis.dot(link.moment);
    parent.force += link.force;
    parent.moment += link.moment;
    parent.subtree_mass += link.subtree_mass;
    parent.subtree_moment += link.subtree_moment;
    parent.subtree_inertia += link.subtree_inertia;
  }
  bias_.head<3>() = links_[0].force;
  bias_.segment<3>(3) = links_[0].moment;
}

void RigidBody::fill_mass_matrix() {
  const Link& base = links_[0];
  const Vec3& m = base.subtree_moment;
  mass_matrix_.topLeftCorner<3, 3>() = base.subtree_mass * Eigen::Matrix3d::Identity();
  Eigen::Matrix3d cross;
  cross << 0.0, -m.z(), m.y(), m.z(), 0.0, -m.x(), -m.y(), m.x(), 0.0;
  mass_matrix_.block<3, 3>(3, 0) = cross;
  mass_matrix_.block<3, 3>(0, 3) = cross.transpose();
  mass_matrix_.block<3, 3>(3, 3) = base.subtree_inertia.selfadjointView<Eigen::Upper>();
  for (std::size_t i = 1; i < links_.size(); ++i) {
    const Link& link = links_[i];
    const auto column = static_cast<Eigen::Index>(i) + 5;
    // Momentum of everything that joint i carries when it alone turns at 1 rad/s.
    const Vec3 linear = link.subtree_mass * link.axis_moment + link.axis.cross(link.subtree_moment);
    const Vec3 angular =
        link.subtree_inertia * link.axis + link.subtree_moment.cross(link.axis_moment);
    for (int k = static_cast<int>(i); k > 0; k = links_[k].parent) {
      const double entry = links_[k].axis_moment.dot(linear) + links_[k].axis.dot(angular);
      mass_matrix_(k + 5, column) = entry;
      mass_matrix_(column, k + 5) = entry;
    }
    mass_matrix_.block<3, 1>(0, column) = linear;
    mass_matrix_.block<3, 1>(3, column) = angular;
    mass_matrix_.block<1, 3>(column, 0) = linear.transpose();
    mass_matrix_.block<1, 3>(column, 3) = angular.transpose();
  }
}

void RigidBody::derive_centroidal(double gravity) {
  const Link& base = links_[0];
  com_ = base.subtree_moment / mass_;
  // The first six rows of the mass matrix are the robot's momentum about the base's origin.
  com_jacobian_.noalias() = mass_matrix_.topRows<3>() / mass_;
  for (Eigen::Index column = 0; column < nv_; ++column) {
    const Vec3 linear = mass_matrix_.block<3, 1>(0, column);
    angular_momentum_matrix_.col(column) = mass_matrix_.block<3, 1>(3, column) - com_.cross(linear);
  }
  com_velocity_.setZero();
  for (const Link& link : links_) {
    com_velocity_ += link.mass * (link.velocity + link.omega.cross(link.com));
  }
  com_velocity_ /= mass_;
  com_bias_acceleration_ = bias_.head<3>() / mass_ - Vec3(0.0, 0.0, gravity);
  angular_momentum_bias_ = bias_.segment<3>(3) - com_.cross(base.force);
}

Eigen::Isometry3d RigidBody::pose(int body) const {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = links_[body].rotation;
  result.translation() = position(body);
  return result;
}

Vec6 RigidBody::velocity(int body, const Vec3& point) const {
  const Link& link = links_[body];
  Vec6 result;
  result.head<3>() = link.velocity + link.omega.cross(point - base_position_);
  result.tail<3>() = link.omega;
  return result;
}

void RigidBody::jacobian(int body, const Vec3& point, Eigen::Ref<Matrix6X> out) const {
  assert(out.cols() == nv_);
  const Vec3 arm = point - base_position_;
  out.setZero();
  out(0, 0) = out(1, 1) = out(2, 2) = 1.0;
  out(3, 3) = out(4, 4) = out(5, 5) = 1.0;
  out(0, 4) = arm.z();
  out(0, 5) = -arm.y();
  out(1, 3) = -arm.z();
  out(1, 5) = arm.x();
  out(2, 3) = arm.y();
  out(2, 4) = -arm.x();
  for (int k = body; k > 0; k = links_[k].parent) {
    const Link& link = links_[k];
    out.block<3, 1>(0, k + 5) = link.axis.cross(arm - link.origin);
    out.block<3, 1>(3, k + 5) = link.axis;
  }
}

Vec6 RigidBody::bias_acceleration(int body, const Vec3& point) const {
  const Link& link = links_[body];
  const Vec3 arm = point - base_position_;
  const Vec3 velocity = link.velocity + link.omega.cross(arm);
  Vec6 result;
  result.head<3>() = link.acceleration + link.alpha.cross(arm) + link.omega.cross(velocity);
  result.tail<3>() = link.alpha;
  return result;
}

}  // namespace stagger::sim
