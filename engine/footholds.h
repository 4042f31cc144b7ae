// Where the foot in the air can be put down, and where it has to be: the two regions that say
// whether a step can save the robot.
#pragma once

#include <span>

#include "engine/convex_polygon.h"
#include "engine/step_adjuster.h"

namespace stagger::engine {

/// Corners of a convex region of the ground, counter-clockwise, world frame [m]. No heap.
struct FootholdRegion {
  static constexpr std::size_t capacity = 16;
  std::array<Vec2, capacity> corners;
  std::size_t count = 0;

  std::span<const Vec2> view() const { return std::span(corners).first(count); }
};

/// A polygon given in the frame of a foot, in the world.
FootholdRegion in_world(const ConvexPolygon& polygon, const Footstep& foot);

/// What a step under way has to bring about, beside its StepSituation.
struct CaptureDemand {
  double left = 0.0;                      ///< until touchdown [s]
  double t_ds = 0.0;                      ///< double support that follows [s]
  double omega = 1.0;                     ///< [1/s]
  std::span<const Vec2> zmp;              ///< corners of where it can be until then, world [m]
  const ConvexPolygon* viable = nullptr;  ///< viable_dcm() in the frame of the foot that lands
};

/// All footholds from which a fall can be avoided if the foot lands there at that time: with a ZMP
/// p held until touchdown, zeta_TD = p + (zeta - p) e^{w tau}, and as in CatchingLine
///   f = f_i + (zeta_TD - f_i - e^{-w Tds} b) / gamma,
/// now for every p that the stance foot can give and every DCM b (from the new foot, at the next
/// lift-off) that is viable: a Minkowski sum of the two sets. The leg's reach is left aside: a fall
/// can be avoided by a step where this region and the reachable one overlap.
FootholdRegion capturing_footholds(const StepSituation& step, const CaptureDemand& demand);

}  // namespace stagger::engine
