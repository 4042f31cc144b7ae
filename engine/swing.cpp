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

// Of seven control points the middle one alone is the height: the curve is highest half-way, with
// this share of it.
constexpr double middle_weight = 20.0 / 64.0;
// The middle one and the one before it are: highest here, where d/ds 5 s^2 (1 - s)^3 (3 + s) = 0.
constexpr double early_peak = std::numbers::sqrt2 - 1.0;

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
  since_ = 0.0;
  duration_ = duration;
  const double z0 = start.position.z();
  const double z1 = target.position.z();
  // It comes up with an acceleration, while its way over the ground begins with a jerk alone: a toe
  // that is dragged before it is up catches at edges of a few millimetres.
  const double peak = std::max(z0, z1) + height;
  const double rest = 1.0 - early_peak;
  const double start_weight = std::pow(rest, 5) * (rest + 6.0 * early_peak);
  const double both_weight = 5.0 * early_peak * early_peak * std::pow(rest, 3) * (3.0 + early_peak);
  const double end_weight = 1.0 - start_weight - both_weight;
  const double both = (peak - start_weight * z0 - end_weight * z1) / both_weight;
  lift_ = {z0, z0, both, both, z1, z1, z1};
}

void SwingTrajectory::lift(double height) {
  const double mean = 0.5 * (lift_.front() + lift_.back());
  const double peak = std::max(lift_.front(), lift_.back()) + height;
  lift_[3] = mean + (peak - mean) / middle_weight;
}

void SwingTrajectory::retarget(const FootPose& target, double time, double duration) {
  const double s = share(time);
  CurvePoint<Planar> ground = evaluate_bezier<Planar, 5>(planar_, s);
  CurvePoint<double> up = evaluate_bezier<double, 6>(lift_, s);
  ground.first /= span();
  ground.second /= span() * span();
  up.first /= span();
  up.second /= span() * span();
  // What is left of the old curve keeps its middle point: so the foot clears the ground as before.
  const double middle = rest_of_bezier<double, 6>(lift_, s)[3];

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
           up.value + up.first * (d / 6.0),
           up.value + up.first * (2.0 * d / 6.0) + up.second * (d * d / 30.0),
           middle,
           z1,
           z1,
           z1};
}

FootTarget SwingTrajectory::at(double time) const {
  const double s = share(time);
  const double d = span();
  const CurvePoint<Planar> ground = evaluate_bezier<Planar, 5>(planar_, s);
  const CurvePoint<double> up = evaluate_bezier<double, 6>(lift_, s);
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
    foot.position.z() -= landing_speed_ * (time - duration_);
    foot.velocity << 0.0, 0.0, -landing_speed_;
    foot.acceleration.setZero();
    foot.yaw_velocity = 0.0;
    foot.yaw_acceleration = 0.0;
  }
  return foot;
}

}  // namespace stagger::engine
