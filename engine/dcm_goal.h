// Where the DCM has to get to, and the ZMP that takes it there.
#pragma once

#include "engine/convex_polygon.h"

namespace stagger::engine {

/// Where the DCM is wanted at a time to come: inside a polygon that lies in the frame of a foot.
struct DcmGoal {
  const ConvexPolygon* region = nullptr;
  Vec2 origin = Vec2::Zero();  ///< of the foot, world frame [m]
  double yaw = 0.0;            ///< of the foot [rad]
  double growth = 1.0;         ///< e^{w T}, T: time until then
  /// The ZMP that, held until then, would do to the DCM what the plan's moving ZMP does [m].
  Vec2 held = Vec2::Zero();
};

/// The ZMP in `support`, near to `wanted`, that takes the DCM into the goal if it is held until
/// then; where none does, one that misses it by the least. `wanted` lies in `support`; it is the
/// answer when it does.
Vec2 zmp_towards(const DcmGoal& goal, const Vec2& wanted, const Vec2& dcm,
                 const ConvexPolygon& support);

}  // namespace stagger::engine
