#include "sim/experiment/push_ceiling.h"

#include <algorithm>
#include <cmath>

namespace stagger::sim {

double delta_v_ceiling(const engine::ConvexSet& viable, const engine::Vec2& dcm,
                       const engine::Vec2& direction, double duration, double omega) {
  // Seen from its end, the push is a shift of the DCM at its beginning, whatever the ZMP does:
  // F / (m w^2) (1 - e^{-w d}), with F d / m the change of velocity.
  const double shift = -std::expm1(-omega * duration) / (omega * omega * duration);
  return engine::ray_exit(engine::shifted(viable, -dcm), direction) / shift;
}

double push_ceiling(const engine::StepAbility& ability, const CeilingPush& push) {
  const double earliest = std::max(push.t_left - ability.sooner, push.duration);
  const double latest = std::max(push.t_left + ability.later, earliest);
  return delta_v_ceiling(engine::viable_dcm(ability, earliest, latest), push.dcm, push.direction,
                         push.duration, ability.omega) *
         push.mass / push.duration;
}

}  // namespace stagger::sim
