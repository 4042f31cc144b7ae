// Steps of a robot that stands: when ankle and hips cannot bring it back, and on which foot it can.
#pragma once

#include "engine/capture_region.h"
#include "engine/step_adjuster.h"
#include "engine/support_polygon.h"

namespace stagger::engine {

/// From standing a step can begin at any time and with either foot. While one foot stands it saves
/// the DCMs of its capture region, which knows of both manoeuvres: the other foot put down far out
/// at once, and a narrow step beside the foot that stands, after which that one steps far out.
class Recovery {
 public:
  Recovery(const Parameters& parameters, const ReachRegion& reach);

  /// Where the steps of a recovery can land. A step that is both long and wide asks for more of the
  /// leg than either: from standing there is no time to take the body along, so instead of the
  /// region's outer corners an ellipse bounds them, about the place of the foot side by side.
  const ReachRegion& reach() const { return reach_; }
  /// The part that the step time is adjusted for.
  const ReachRegion& time_reach() const { return time_reach_; }

  /// Is the DCM lost without a step? With the ZMP at its best it comes back from everywhere inside
  /// of the support polygon, and from nowhere outside. It has to be outside by more than the doubt
  /// about it, `deviation` (standard deviation of the estimate [m]), and than what the hips can
  /// bring back. Soles that overlap stand as one foot, which cannot step.
  bool needed(const Vec2& dcm, double deviation, const PerFoot<FootPose>& feet,
              const Strategies& strategies) const;

  /// The foot from which the DCM is farther inside of what can be saved (less far outside where it
  /// cannot be): that one stands, the other one steps.
  Side support_side(const Vec2& dcm, const PerFoot<FootPose>& feet, bool free_times) const;

  /// Can it stand on these feet? So it can with the DCM in the hull of the soles, of which a part
  /// is kept back.
  bool can_stand(const Vec2& dcm, const PerFoot<FootPose>& feet) const;

  /// Will it be able to stand when this step has landed where it is planned? So it will if some ZMP
  /// in the stance sole, held for the time `left`, takes the DCM to where it can.
  bool will_stand(const StepSituation& step, double left, double omega) const;

  /// Single support of the first step, before adjustment [s].
  double step_time(bool free_times) const { return free_times ? quick_t_ss_ : nominal_t_ss_; }

 private:
  /// Where the DCM may be for the robot to come to rest on these feet.
  ConvexPolygon standing(const PerFoot<FootPose>& feet) const;

  double nominal_t_ss_;
  double quick_t_ss_;
  Sole sole_;        ///< where the ZMP can be
  Sole whole_sole_;  ///< that must not overlap
  double hip_reserve_;
  ReachRegion reach_;
  ReachRegion time_reach_;
  CaptureRegion fixed_;  ///< for nominal_t_ss_
  CaptureRegion free_;   ///< for quick_t_ss_, which may be adjusted
};

}  // namespace stagger::engine
