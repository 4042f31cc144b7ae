#include "sim/experiment/peers/capture_set.h"

#include "engine/lipm.h"
#include "engine/reference.h"

namespace stagger::sim {

using engine::Side;
using engine::Vec2;

CaptureSet::CaptureSet(const PointWalker& walker) {
  ability_.omega = walker.omega;
  ability_.sole = {Vec2::Zero()};
  ability_.reach = engine::corners(walker.reach.polygon(Side::left));
  ability_.t_ss = walker.t_max;
  ability_.t_ds = 0.0;
  ability_.sooner = walker.t_max - walker.t_min;
  const engine::ConvexSet left = engine::viable_dcm(ability_);
  sets_ = {left, engine::mirrored(left)};
}

double CaptureSet::margin(Side stance, const Vec2& dcm_offset) const {
  return engine::margin(polygon(stance), dcm_offset);
}

double CaptureSet::margin(Side stance, const Vec2& dcm_offset, double earliest,
                          double latest) const {
  const Vec2 as_left(dcm_offset.x(), dcm_offset.y() * engine::lateral_sign(stance));
  return engine::margin(engine::viable_dcm(ability_, earliest, latest), as_left);
}

bool walks_on(const PointWalker& walker, Side stance, const Vec2& dcm_offset) {
  const double time = walker.t_min;
  const auto middling_step = [&](Side from) {
    const engine::ConvexPolygon& reach = walker.reach.polygon(from);
    Vec2 mean = Vec2::Zero();
    for (std::size_t i = 0; i < reach.size(); ++i) mean += reach.vertex(i);
    return Vec2(mean / static_cast<double>(reach.size()));
  };
  const auto middling_offset = [&](Side on) {
    return engine::periodic_dcm_offset(middling_step(on), middling_step(engine::other(on)), time,
                                       0.0, walker.omega);
  };
  constexpr double lost = 10.0;
  constexpr double settled = 1e-9;
  constexpr int steps = 1000;  // on the very edge of what can be caught neither end is reached
  Vec2 offset = dcm_offset;
  for (int i = 0; i < steps; ++i) {
    if (!(offset.norm() < lost)) return false;
    if ((offset - middling_offset(stance)).norm() < settled) return true;
    const Vec2 touchdown = engine::dcm_after(offset, Vec2::Zero(), time, walker.omega);
    const Vec2 wanted = touchdown - middling_offset(engine::other(stance));
    offset = touchdown - walker.reach.polygon(stance).clamp(wanted);
    stance = engine::other(stance);
  }
  return true;
}

}  // namespace stagger::sim
