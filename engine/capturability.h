// Which states of the linear inverted pendulum a walker can still save, by whatever choice of ZMP,
// footholds and step times. docs/capturability.md derives it.
#pragma once

#include "engine/convex_set.h"
#include "engine/reach.h"

namespace stagger::engine {

/// What a walker is able to do. Places are told for the left foot standing, in its frame; the right
/// foot's are their mirror image.
struct StepAbility {
  double omega = 0.0;  ///< [1/s]
  ConvexSet sole;      ///< where the ZMP can be while this foot stands [m]
  ConvexSet reach;     ///< where the right foot can land; a single point: steps stay as planned [m]
  double t_ss = 0.8;   ///< nominal single support [s]
  double t_ds = 0.2;   ///< double support [s]
  double sooner = 0.0;  ///< by how much single support can be shortened; less than a step lasts [s]
  double later = 0.0;   ///< and lengthened [s]
};

/// What a robot with these parameters is able to do with its nominal step times, or with all that
/// the limits of the step time allow.
StepAbility step_ability(const Parameters& parameters, const ReachRegion& reach, bool free_times);

/// The same region without its outer corners: of places wider than `width` [m] those inside of an
/// ellipse (or rather of a polygon inscribed in it) about the place at that width, straight beside
/// the stance foot. Nothing is added.
ReachRegion rounded(const ReachRegion& reach, double width);

/// DCM from the stance foot (left) at its lift-off from which a fall can be avoided for ever. The
/// hull of the true region where step times are free, and exact where they are not: no controller
/// does better. Throws std::invalid_argument when steps can last no time at all.
ConvexSet viable_dcm(const StepAbility& ability);

/// The same in mid-step, with single support ending `earliest` to `latest` from now [s].
ConvexSet viable_dcm(const StepAbility& ability, double earliest, double latest);

}  // namespace stagger::engine
