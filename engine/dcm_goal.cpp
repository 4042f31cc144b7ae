#include "engine/dcm_goal.h"

namespace stagger::engine {

Vec2 zmp_towards(const DcmGoal& goal, const Vec2& wanted, const Vec2& dcm,
                 const ConvexPolygon& support) {
  const double gain = goal.growth - 1.0;
  if (goal.region == nullptr || gain <= 0.0) return wanted;
  // zeta_T = dcm + (dcm - zmp) (e^{w T} - 1): the ZMPs of the support become a polygon, too, and
  // projecting by turns on the one and on the other ends where they meet or are nearest.
  Vec2 zmp = wanted;
  constexpr int most_turns = 16;
  for (int turn = 0; turn < most_turns; ++turn) {
    const Vec2 then = dcm + (dcm - zmp) * gain;
    const Vec2 local = rotated(then - goal.origin, -goal.yaw);
    const Vec2 nearest = goal.region->clamp(local);
    constexpr double enough = 1e-6;  // [m]
    if ((nearest - local).squaredNorm() < enough * enough) break;
    const Vec2 better = goal.origin + rotated(nearest, goal.yaw);
    const Vec2 next = support.clamp(dcm - (better - dcm) / gain);
    const bool settled = (next - zmp).squaredNorm() * gain * gain < enough * enough;
    zmp = next;
    if (settled) break;
  }
  return zmp;
}

}  // namespace stagger::engine
