#include "sim/experiment/push_ceiling.h"

#include <algorithm>
#include <cmath>

namespace stagger::sim {

using engine::ConvexSet;

double push_ceiling(const engine::StepAbility& ability, const CeilingPush& push) {
  const double left = push.t_left - push.duration;
  const double earliest = std::max(left - ability.sooner, 0.0);
  const ConvexSet after =
      engine::viable_dcm(ability, earliest, std::max(left + ability.later, earliest));
  // zeta' = E zeta - (E - 1) p + (E - 1) / (m w^2) F with E = e^{w duration}.
  const double growth = std::expm1(ability.omega * push.duration);
  const ConvexSet jump =
      engine::shifted(engine::minkowski_sum(after, engine::scaled(ability.sole, growth)),
                      -(1.0 + growth) * push.dcm);
  return engine::ray_exit(jump, push.direction) * push.mass * ability.omega * ability.omega /
         growth;
}

}  // namespace stagger::sim
