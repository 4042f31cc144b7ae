#include "engine/swing.h"

#include <algorithm>
#include <numbers>

namespace stagger::engine {
namespace {

Eigen::Vector3d planar(const FootPose& pose) {
  return {pose.position.x(), pose.position.y(), pose.yaw};
}

// Height of the Bezier curve with all but its middle one of seven control points at zero.
constexpr double middle_control_of_unit_peak = 3.2;  // 1 / (20 / 2^6)

}  // namespace

void SwingTrajectory::start(const FootPose& start, const FootPose& target, double duration,
                            double height) {
  const Planar from = planar(start);
  Planar to = planar(target);
  to.z() = from.z() + std::remainder(to.z() - from.z(), 2.0 * std::numbers::pi);
  planar_ = {from, from, from, to, to, to};
  planar_start_ = 0.0;
  duration_ = duration;
  const double z0 = start.position.z();
  const double z1 = target.position.z();
  const double middle = 0.5 * (z0 + z1) + middle_control_of_unit_peak *
                                              (std::max(z0, z1) + height - 0.5 * (z0 + z1));
  lift_ = {z0, z0, z0, middle, z1, z1, z1};
}

CurvePoint<SwingTrajectory::Planar> SwingTrajectory::planar_at(double time) const {
  const double span = std::max(duration_ - planar_start_, 1e-6);
  const double s = std::clamp((time - planar_start_) / span, 0.0, 1.0);
  CurvePoint<Planar> point = evaluate_bezier<Planar, 5>(planar_, s);
  point.first /= span;
  point.second /= span * span;
  return point;
}

void SwingTrajectory::retarget(const FootPose& target, double time, double duration) {
  const CurvePoint<Planar> now = planar_at(time);
  Planar to = planar(target);
  to.z() = now.value.z() + std::remainder(to.z() - now.value.z(), 2.0 * std::numbers::pi);
  const double d = std::max(duration - time, 1e-6);
  planar_ = {now.value,
             now.value + now.first * (d / 5.0),
             now.value + now.first * (2.0 * d / 5.0) + now.second * (d * d / 20.0),
             to,
             to,
             to};
  planar_start_ = time;
  duration_ = duration;
  lift_[4] = lift_[5] = lift_[6] = target.position.z();
}

FootTarget SwingTrajectory::at(double time) const {
  const CurvePoint<Planar> ground = planar_at(time);
  const double s = std::clamp(time / duration_, 0.0, 1.0);
  const CurvePoint<double> up = evaluate_bezier<double, 6>(lift_, s);
  FootTarget foot;
  foot.position << ground.value.x(), ground.value.y(), up.value;
  foot.velocity << ground.first.x(), ground.first.y(), up.first / duration_;
  foot.acceleration << ground.second.x(), ground.second.y(), up.second / (duration_ * duration_);
  foot.yaw = ground.value.z();
  foot.yaw_velocity = ground.first.z();
  foot.yaw_acceleration = ground.second.z();
  foot.in_contact = false;
  if (time > duration_) {  // the ground is lower than it was thought: feel for it
    foot.position.z() -= landing_speed * (time - duration_);
    foot.velocity << 0.0, 0.0, -landing_speed;
    foot.acceleration.setZero();
    foot.yaw_velocity = 0.0;
    foot.yaw_acceleration = 0.0;
  }
  return foot;
}

}  // namespace stagger::engine
