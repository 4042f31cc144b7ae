// The greatest push that any controller of the linear inverted pendulum could survive.
#pragma once

#include "engine/capturability.h"

namespace stagger::sim {

/// A push by a constant force on the CoM during single support of the left foot.
struct CeilingPush {
  engine::Vec2 direction{1.0, 0.0};  ///< unit vector
  double duration = 0.01;            ///< [s]
  double t_left = 0.0;               ///< of nominal single support when it begins [s]
  double mass = 30.0;                ///< [kg]
  engine::Vec2 dcm{0.0, 0.0};        ///< from the stance foot when it begins [m]
};

/// Greatest force [N] of this push after which a fall can be avoided; the ZMP is free inside the
/// sole during the push as well. The foot does not land before the push is over.
double push_ceiling(const engine::StepAbility& ability, const CeilingPush& push);

/// Greatest change of velocity [m/s] that a constant force may give to the CoM along `direction`
/// within `duration`, from `dcm` on, so that a fall can be avoided; `viable` holds the DCMs from
/// which it could be without the push. Whatever the walker does meanwhile, landings included.
/// Negative: not even without a push.
double delta_v_ceiling(const engine::ConvexSet& viable, const engine::Vec2& dcm,
                       const engine::Vec2& direction, double duration, double omega);

}  // namespace stagger::sim
