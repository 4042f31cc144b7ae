// The swing foot's way from lift-off to landing, replanned without a jump in position, velocity or
// acceleration when the landing place or time changes.
#pragma once

#include "engine/bezier.h"
#include "engine/walking_targets.h"

namespace stagger::engine {

class SwingTrajectory {
 public:
  /// Lift-off at rest from `start`; lands on `target` (z: the ground there) after `duration` [s],
  /// with the sole `height` above the higher of the two ends at its highest.
  void start(const FootPose& start, const FootPose& target, double duration, double height);

  /// New landing place, and a new landing time `duration` since lift-off; keeps the present
  /// position, velocity and acceleration. `time` is now, since lift-off [s].
  void retarget(const FootPose& target, double time, double duration);

  /// Target of the foot at `time` since lift-off [s]. After `duration` the foot goes on down at
  /// `landing_speed` until someone sees it land.
  FootTarget at(double time) const;

  double duration() const { return duration_; }

  static constexpr double landing_speed = 0.1;  ///< [m/s]

 private:
  using Planar = Eigen::Vector3d;  ///< x, y, yaw

  double span() const;
  double share(double time) const;

  std::array<Planar, 6> planar_;  ///< degree 5, from since_ to duration_
  std::array<double, 7> lift_{};  ///< degree 6, likewise
  double since_ = 0.0;            ///< lift-off or last replanning [s]
  double duration_ = 1.0;
};

}  // namespace stagger::engine
