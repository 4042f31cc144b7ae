#include "engine/tuning.h"

namespace stagger::engine {
Tuning::Tuning(const Parameters& p) : Tuning(p, ReachRegion(validate(p))) {}

Tuning::Tuning(const Parameters& p, const ReachRegion& region)
    : parameters(validate(p)),
      reach(region),
      time_reach(region.scaled_length(p.time_reach)),
      capture(p, region),
      recovery(p, region),
      lqg(p) {}

bool same_body(const Parameters& a, const Parameters& b) {
  return a.tick == b.tick && a.gravity == b.gravity && a.com_height == b.com_height &&
         a.mass == b.mass && a.foot_half_length == b.foot_half_length &&
         a.foot_half_width == b.foot_half_width && a.sole_margin == b.sole_margin &&
         a.ankle_reach == b.ankle_reach && a.hip.torque == b.hip.torque &&
         a.hip.inertia == b.hip.inertia && a.hip.angle == b.hip.angle && a.hip.rate == b.hip.rate;
}

}  // namespace stagger::engine
