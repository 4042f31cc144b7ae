// Where the next foot has to land so that the robot catches itself: eqs. (10) and (11), corrected.
#pragma once

#include "engine/parameters.h"

namespace stagger::engine {

/// What the adjuster knows of the step under way. World frame.
struct StepSituation {
  Footstep stance;                    ///< f_i
  Footstep planned;                   ///< f_{i+1}, from the footstep planner
  Vec2 dcm = Vec2::Zero();            ///< estimated DCM now
  Vec2 nominal_dcm = Vec2::Zero();    ///< DCM that the plan wants at touchdown
  double time_left = 0.0;             ///< until touchdown [s]
  double transfer = 1.0;              ///< gamma of the double support that follows
};

struct StepAdjustment {
  Footstep step;                      ///< the step to take
  Vec2 error = Vec2::Zero();          ///< Delta_f: how far the plan is from catching the DCM [m]
  bool adjusted = false;              ///< error beyond the compliance margin
};

/// Delta_f = (zeta_TD - zeta_TD*) / gamma with zeta_TD = f_i + (zeta - f_i) e^{w tau}; the step goes
/// to f_{i+1} + k_sa Delta_f, always from the plan (nothing accumulates), clamped to what the leg
/// reaches. Printed, (10) mixes a foot-relative term with a world one and (11) has the wrong sign.
StepAdjustment adjust_step(const StepSituation& situation, double omega,
                           const Parameters& parameters);

}  // namespace stagger::engine
