// What a walker without soles can still catch: the bound for every planner of steps and their
// times.
#pragma once

#include "engine/capturability.h"
#include "engine/reach.h"

namespace stagger::sim {

/// A point mass on point feet, without double support: all that it has is the place and the time of
/// its steps. Feet keep the yaw 0.
struct PointWalker {
  double omega = 0.0;  ///< [1/s]
  double t_min = 0.0;  ///< least time from one touchdown to the next [s]
  double t_max = 0.0;  ///< greatest [s]
  engine::ReachRegion reach;
};

/// The DCM offsets from the stance foot right after touchdown from which the walker can go on for
/// ever: engine::viable_dcm() of a sole that is a point.
class CaptureSet {
 public:
  explicit CaptureSet(const PointWalker& walker);

  /// Of the DCM from the new stance foot at touchdown; negative outside [m].
  double margin(engine::Side stance, const engine::Vec2& dcm_offset) const;
  /// The same when the step under way can end between `earliest` and `latest` from now [s].
  double margin(engine::Side stance, const engine::Vec2& dcm_offset, double earliest,
                double latest) const;
  const engine::ConvexSet& polygon(engine::Side stance) const {
    return sets_[engine::index(stance)];
  }

 private:
  engine::StepAbility ability_;
  engine::PerFoot<engine::ConvexSet> sets_;
};

/// Lets the walker go on from right after a touchdown, always with its best reaction, until its DCM
/// is on the gait of middling steps (true) or metres away from the foot (false). Soonest is best
/// when the stance foot lies within R + C': what can be caught after a longer step can then be
/// caught after a shorter one, too. And with a box to step into, the foothold nearest to the one
/// that leads onto the middling gait is best on both axes. Knows nothing of CaptureSet: where these
/// reasons do not hold, the two disagree.
bool walks_on(const PointWalker& walker, engine::Side stance, const engine::Vec2& dcm_offset);

}  // namespace stagger::sim
