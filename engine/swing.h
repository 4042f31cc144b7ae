// The swing foot's way from lift-off to landing, replanned without a jump in position, velocity or
// acceleration when the landing place or time changes.
#pragma once

#include "engine/bezier.h"
#include "engine/walking_targets.h"

namespace stagger::engine {

/// About the time that a foot at `velocity` needs to come `way` farther and to rest there, if its
/// acceleration stays below a limit; `duration` [s] is a guess. A smooth step of degree 5 over d in
/// T is at its hardest at 10 / sqrt(3) d / T^2, and a foot that only comes to rest goes v T / 2.
double least_time(const Vec2& way, const Vec2& velocity, double duration, double acceleration);

class SwingTrajectory {
 public:
  /// Goes on down from when it should have landed until someone sees it land: with `speed` [m/s]
  /// at first, and faster by `acceleration` [m/s^2].
  explicit SwingTrajectory(double speed = 0.0, double acceleration = 0.0)
      : landing_speed_(speed), landing_acceleration_(acceleration) {}
  void set_landing(double speed, double acceleration) {
    landing_speed_ = speed;
    landing_acceleration_ = acceleration;
  }

  /// Lift-off at rest from `start`, up before it goes forward; lands on `target` (z: the ground
  /// there) after `duration` [s], with the sole `height` above the higher of the two ends at its
  /// highest.
  void start(const FootPose& start, const FootPose& target, double duration, double height);

  /// New landing place, and a new landing time `duration` since lift-off; keeps the present
  /// position, velocity and acceleration. `time` is now, since lift-off [s].
  void retarget(const FootPose& target, double time, double duration);

  /// After retarget(): on the way from there it rises by `height` once more.
  void lift(double height);

  /// The foot is held at `place`: from there it goes on over the ground, from rest, and comes up as
  /// it was to.
  void hold(const FootPose& place, double time);

  /// A late foot, while it feels for the ground, goes after `place`: a tick of a critically damped
  /// way there, at `rate` [1/s].
  void go_after(const Vec2& place, double rate, double tick);

  /// Target of the foot at `time` since lift-off [s].
  FootTarget at(double time) const;

  double duration() const { return duration_; }
  double landing_height() const { return lift_.back(); }

 private:
  using Planar = Eigen::Vector3d;  ///< x, y, yaw

  double span() const;
  double share(double time) const;

  std::array<Planar, 6> planar_;  ///< degree 5, from since_ to duration_
  std::array<double, 8> lift_{};  ///< degree 7, likewise
  double since_ = 0.0;            ///< lift-off or last replanning [s]
  double duration_ = 1.0;
  double landing_speed_;
  double landing_acceleration_;
  Vec2 late_velocity_ = Vec2::Zero();  ///< of a late foot over the ground [m/s]
};

}  // namespace stagger::engine
