#include "engine/swing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stagger::engine {
namespace {

Eigen::Vector3d planar(const FootPose& pose) {
  return {pose.position.x(), pose.position.y(), pose.yaw};
}

/// The yaw of `target` that is nearest to `from`: a foot turns the short way round.
Eigen::Vector3d planar_near(const FootPose& target, double from_yaw) {
  Eigen::Vector3d to = planar(target);
  to.z() = from_yaw + std::remainder(to.z() - from_yaw, 2.0 * std::numbers::pi);
  return to;
}

// Control points of a height that has 1 at its highest, there. It comes up with an acceleration,
// while the way over the ground begins with a jerk alone: a toe that is dragged before it is up
// catches at edges of a few millimetres. It comes down about as 64 s^3 (1 - s)^3 does: lower, a
// foot that walks uphill would land early.
constexpr std::array<double, 8> rise = {0.0, 0.0, 1.048799, 1.048799, 1.95, 0.0, 0.0, 0.0};
constexpr double highest = 0.4705;
// What the two middle ones of eight are of the height half-way.
constexpr double middle_weight = 70.0 / 128.0;

constexpr double least_span = 1e-6;  // [s]

}  // namespace

double least_time(const Vec2& way, const Vec2& velocity, double duration, double acceleration) {
  constexpr double hardest = 10.0 / std::numbers::sqrt3;
  return std::sqrt(hardest * (way - 0.5 * duration * velocity).norm() / acceleration);
}

double SwingTrajectory::span() const { return std::max(duration_ - since_, least_span); }

double SwingTrajectory::share(double time) const {
  return std::clamp((time - since_) / span(), 0.0, 1.0);
}

void SwingTrajectory::start(const FootPose& start, const FootPose& target, double duration,
                            double height) {
  const Planar from = planar(start);
  const Planar to = planar_near(target, from.z());
  planar_ = {from, from, from, to, to, to};
  late_velocity_.setZero();
  since_ = 0.0;
  duration_ = duration;
  const double z0 = start.position.z();
  const double z1 = target.position.z();
  const double mean = 0.5 * (z0 + z1);
  lift_ = {z0, z0, mean, mean, mean, z1, z1, z1};
  const double peak = std::max(z0, z1) + height;
  const double wanted = peak - evaluate_bezier<double, 7>(lift_, highest).value;
  for (std::size_t i = 0; i < lift_.size(); ++i) lift_[i] += wanted * rise[i];
}

void SwingTrajectory::lift(double height) {
  const double mean = 0.5 * (lift_.front() + lift_.back());
  const double peak = std::max(lift_.front(), lift_.back()) + height;
  lift_[3] = lift_[4] = mean + (peak - mean) / middle_weight;
}

void SwingTrajectory::retarget(const FootPose& target, double time, double duration) {
  const double s = share(time);
  CurvePoint<Planar> ground = evaluate_bezier<Planar, 5>(planar_, s);
  CurvePoint<double> up = evaluate_bezier<double, 7>(lift_, s);
  ground.first /= span();
  ground.second /= span() * span();
  up.first /= span();
  up.second /= span() * span();
  // What is left of the old curve keeps its middle points: so the foot clears the ground as before.
  const std::array<double, 8> rest = rest_of_bezier<double, 7>(lift_, s);

  since_ = time;
  duration_ = duration;
  const double d = span();
  const Planar to = planar_near(target, ground.value.z());
  planar_ = {ground.value,
             ground.value + ground.first * (d / 5.0),
             ground.value + ground.first * (2.0 * d / 5.0) + ground.second * (d * d / 20.0),
             to,
             to,
             to};
  const double z1 = target.position.z();
  lift_ = {up.value,
           up.value + up.first * (d / 7.0),
           up.value + up.first * (2.0 * d / 7.0) + up.second * (d * d / 42.0),
           rest[3],
           rest[4],
           z1,
           z1,
           z1};
}

void SwingTrajectory::hold(const FootPose& place, double time) {
  const Planar to = planar_.back();
  retarget({Vec3(to.x(), to.y(), lift_.back()), to.z()}, time, duration_);
  const Planar here(place.position.x(), place.position.y(), planar_.front().z());
  planar_ = {here, here, here, to, to, to};
}

void SwingTrajectory::go_after(const Vec2& place, double rate, double tick) {
  // In closed form: stable at any rate.
  Planar here = planar_.back();
  const Vec2 off = here.head<2>() - place;
  const Vec2 slope = late_velocity_ + rate * off;
  const double decay = std::exp(-rate * tick);
  here.head<2>() = place + decay * (off + tick * slope);
  late_velocity_ = decay * (late_velocity_ - rate * tick * slope);
  planar_.fill(here);
}

FootTarget SwingTrajectory::at(double time) const {
  const double s = share(time);
  const double d = span();
  const CurvePoint<Planar> ground = evaluate_bezier<Planar, 5>(planar_, s);
  const CurvePoint<double> up = evaluate_bezier<double, 7>(lift_, s);
  FootTarget foot;
  foot.position << ground.value.x(), ground.value.y(), up.value;
  foot.velocity << ground.first.x() / d, ground.first.y() / d, up.first / d;
  foot.acceleration << ground.second.x(), ground.second.y(), up.second;
  foot.acceleration /= d * d;
  foot.yaw = ground.value.z();
  foot.yaw_velocity = ground.first.z() / d;
  foot.yaw_acceleration = ground.second.z() / (d * d);
  foot.in_contact = false;
  if (time > duration_) {  // the ground is lower than it was thought: feel for it
    const double late = time - duration_;
    foot.position.z() -= (landing_speed_ + 0.5 * landing_acceleration_ * late) * late;
    foot.velocity << late_velocity_, -landing_speed_ - landing_acceleration_ * late;
    foot.acceleration << 0.0, 0.0, -landing_acceleration_;
    foot.yaw_velocity = 0.0;
    foot.yaw_acceleration = 0.0;
  }
  return foot;
}

}  // namespace stagger::engine
