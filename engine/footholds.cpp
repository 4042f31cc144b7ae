#include "engine/footholds.h"

#include <algorithm>

namespace stagger::engine {
namespace {

std::size_t lowest(const FootholdRegion& region) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < region.count; ++i) {
    const Vec2& corner = region.corners[i];
    const Vec2& least = region.corners[best];
    if (corner.y() < least.y() || (corner.y() == least.y() && corner.x() < least.x())) best = i;
  }
  return best;
}

/// Both convex and counter-clockwise: their edges one after another in the order of their angles.
FootholdRegion minkowski_sum(const FootholdRegion& a, const FootholdRegion& b) {
  FootholdRegion sum;
  const std::size_t a0 = lowest(a);
  const std::size_t b0 = lowest(b);
  std::size_t i = 0;
  std::size_t j = 0;
  while ((i < a.count || j < b.count) && sum.count < FootholdRegion::capacity) {
    const Vec2& from_a = a.corners[(a0 + i) % a.count];
    const Vec2& from_b = b.corners[(b0 + j) % b.count];
    sum.corners[sum.count++] = from_a + from_b;
    bool along_a = j == b.count;
    bool along_b = i == a.count;
    if (!along_a && !along_b) {
      const double turn = cross(a.corners[(a0 + i + 1) % a.count] - from_a,
                                b.corners[(b0 + j + 1) % b.count] - from_b);
      along_a = turn >= 0.0;
      along_b = turn <= 0.0;
    }
    if (along_a) ++i;
    if (along_b) ++j;
  }
  return sum;
}

}  // namespace

FootholdRegion in_world(const ConvexPolygon& polygon, const Footstep& foot) {
  FootholdRegion region;
  region.count = polygon.size();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    region.corners[i] = foot.position + rotated(polygon.vertex(i), foot.yaw);
  }
  return region;
}

FootholdRegion capturing_footholds(const StepSituation& step, const CaptureDemand& demand) {
  const double growth = std::exp(demand.omega * demand.left);
  const double decay = std::exp(-demand.omega * demand.t_ds);
  // By ZMP: where f would be with a viable DCM of zero. Scaled by a negative number a polygon turns
  // by half a turn and stays counter-clockwise.
  FootholdRegion by_zmp;
  by_zmp.count = std::min(demand.zmp.size(), ConvexPolygon::capacity);
  for (std::size_t i = 0; i < by_zmp.count; ++i) {
    const Vec2& zmp = demand.zmp[i];
    const Vec2 touchdown = zmp + (step.dcm - zmp) * growth;
    by_zmp.corners[i] = step.stance.position + (touchdown - step.stance.position) / step.transfer;
  }
  FootholdRegion by_dcm;
  by_dcm.count = demand.viable->size();
  for (std::size_t i = 0; i < by_dcm.count; ++i) {
    by_dcm.corners[i] =
        rotated(demand.viable->vertex(i), step.planned.yaw) * (-decay / step.transfer);
  }
  if (by_zmp.count == 0 || by_dcm.count == 0) return {};
  return minkowski_sum(by_zmp, by_dcm);
}

}  // namespace stagger::engine
