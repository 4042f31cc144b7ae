// What no controller can do better: the states of the linear inverted pendulum from which a fall
// can still be avoided, and the push that leads just out of them. docs/capturability.md derives it.
#pragma once

#include "sim/experiment/convex_set.h"

namespace stagger::sim {

/// What a robot on the pendulum is able to do. Places are told for the left foot standing, in its
/// frame; the right foot's are their mirror image.
struct StepAbility {
  double omega = 0.0;  ///< [1/s]
  ConvexSet sole;      ///< where the ZMP can be while this foot stands [m]
  ConvexSet reach;     ///< where the right foot can land; a single point: steps stay as planned [m]
  double t_ss = 0.8;   ///< nominal single support [s]
  double t_ds = 0.2;   ///< double support [s]
  double sooner = 0.0;  ///< by how much single support can be shortened [s]
  double later = 0.0;   ///< and lengthened [s]
};

/// DCM from the stance foot (left) at its lift-off from which some choice of ZMP, footholds and
/// step times avoids a fall for ever. The region is the hull of the true one where step times are
/// free, and exact where they are not. Any controller's region lies within.
ConvexSet viable_dcm(const StepAbility& ability);

/// The same in mid-step, with single support ending `earliest` to `latest` from now [s].
ConvexSet viable_dcm(const StepAbility& ability, double earliest, double latest);

/// A push by a constant force on the CoM during single support of the left foot.
struct CeilingPush {
  engine::Vec2 direction{1.0, 0.0};  ///< unit vector
  double duration = 0.01;            ///< [s]
  double t_left = 0.0;               ///< of nominal single support when it begins [s]
  double mass = 30.0;                ///< [kg]
  engine::Vec2 dcm{0.0, 0.0};        ///< from the stance foot when it begins [m]
};

/// Greatest force [N] of this push that a controller can survive; the ZMP is free inside the sole
/// during the push as well.
double push_ceiling(const StepAbility& ability, const CeilingPush& push);

}  // namespace stagger::sim
