#include "engine/recovery.h"

#include <algorithm>

#include "engine/capturability.h"
#include "engine/dcm_goal.h"
#include "engine/lipm.h"
#include "engine/sole_gap.h"
#include "engine/step_limits.h"

namespace stagger::engine {
namespace {

/// So many standard deviations of the estimate may a DCM be wrong.
constexpr double doubted_deviations = 4.0;

/// Of the soles, what the DCM may need to come to rest.
constexpr double standing_share = 0.8;

/// The catching foothold runs away with e^{w T}: the speed that the swing foot needs for it, in
/// proportion to e^{w T} / T, is least for w T = 1. A walk in quick steps takes no slower ones.
Parameters quick_steps(Parameters p) {
  p.t_ss = std::clamp(1.0 / natural_frequency(p), p.least_t_ss, p.t_ss);
  return p;
}

/// The farthest outside of the sole that a DCM can be for a flywheel at rest to bring it back:
/// tau / (m g) (1 - e^{-w T1})^2, T1 = sqrt(J theta / tau) (Pratt et al. 2006, "Capture point").
double hip_reserve(const Parameters& p) {
  if (!(p.hip.torque > 0.0 && p.hip.in_steps)) return 0.0;
  const double swing = std::sqrt(p.hip.inertia * p.hip.angle / p.hip.torque);
  const double kept = -std::expm1(-natural_frequency(p) * swing);
  return p.hip.torque / (p.mass * p.gravity) * kept * kept;
}

}  // namespace

Recovery::Recovery(const Parameters& parameters, const ReachRegion& reach)
    : nominal_t_ss_(parameters.t_ss),
      quick_t_ss_(quick_steps(parameters).t_ss),
      sole_{parameters.foot_half_length - parameters.sole_margin,
            parameters.foot_half_width - parameters.sole_margin},
      whole_sole_(whole_sole(parameters)),
      hip_reserve_(hip_reserve(parameters)),
      reach_(rounded(reach, parameters.stance_width)),
      time_reach_(reach_.scaled_length(parameters.time_reach)),
      fixed_(parameters, reach_),
      free_(quick_steps(parameters), reach_) {}

bool Recovery::needed(const Vec2& dcm, double deviation, const PerFoot<FootPose>& feet,
                      const Strategies& strategies) const {
  const FootPose& left = feet[index(Side::left)];
  const FootPose& right = feet[index(Side::right)];
  const double out = (dcm - support_polygon(sole_, left, right).clamp(dcm)).norm();
  const double kept = doubted_deviations * deviation + (strategies.hip ? hip_reserve_ : 0.0);
  if (!(out > kept)) return false;
  const Vec2 offset = rotated((right.position - left.position).head<2>(), -left.yaw);
  return sole_gap(whole_sole_, offset, right.yaw - left.yaw) > 0.0;
}

Side Recovery::support_side(const Vec2& dcm, const PerFoot<FootPose>& feet, bool free_times) const {
  const CaptureRegion& region = free_times ? free_ : fixed_;
  const auto margin = [&](Side side) {
    const FootPose& foot = feet[index(side)];
    const Vec2 local = rotated(dcm - foot.position.head<2>(), -foot.yaw);
    return region.polygon(side, free_times).margin(local);
  };
  return margin(Side::left) > margin(Side::right) ? Side::left : Side::right;
}

ConvexPolygon Recovery::standing(const PerFoot<FootPose>& feet) const {
  return support_polygon({standing_share * sole_.half_length, standing_share * sole_.half_width},
                         feet[0], feet[1]);
}

bool Recovery::can_stand(const Vec2& dcm, const PerFoot<FootPose>& feet) const {
  return standing(feet).margin(dcm) >= 0.0;
}

bool Recovery::will_stand(const StepSituation& step, double left, double omega) const {
  const auto pose = [](const Footstep& foot) {
    return FootPose{Vec3(foot.position.x(), foot.position.y(), 0.0), foot.yaw};
  };
  const ConvexPolygon hull = standing({pose(step.stance), pose(step.planned)});
  const ConvexPolygon sole = support_polygon(sole_, pose(step.stance));
  const DcmGoal goal{&hull, Vec2::Zero(), 0.0, std::exp(omega * left), Vec2::Zero()};
  const Vec2 zmp = zmp_towards(goal, step.stance.position, step.dcm, sole);
  constexpr double rounding = 1e-4;  // [m]
  return hull.margin(dcm_after(step.dcm, zmp, left, omega)) >= -rounding;
}

}  // namespace stagger::engine
