// Where and when the next foot has to land so that the robot catches itself: eqs. (10) to (13),
// corrected. Printed, (10) mixes a foot-relative term with a world one, (11) has the wrong sign,
// and (12) takes the logarithm of its own prediction, which leaves the time as it is.
#pragma once

#include "engine/parameters.h"
#include "engine/reach.h"
#include "engine/support_polygon.h"

namespace stagger::engine {

/// The foothold that catches the DCM as a function of the time left until touchdown. World frame.
///
/// With the ZMP at p = f_i + ankle, zeta_TD = p + (zeta - p) e^{w tau}; the plan wants
/// zeta_TD = f_i + gamma (f - f_i) + e^{-w Tds} b for a foothold f. Equate them:
///   f(tau) = base + ray e^{w tau},  ray = (zeta - p) / gamma.
struct CatchingLine {
  Vec2 base = Vec2::Zero();
  Vec2 ray = Vec2::Zero();

  Vec2 foothold(double growth) const { return base + growth * ray; }  ///< growth = e^{w tau}
};

/// What the adjusters know of the step under way. World frame.
struct StepSituation {
  Footstep stance;                  ///< f_i
  Footstep planned;                 ///< f_{i+1}, from the footstep planner
  Vec2 dcm = Vec2::Zero();          ///< estimated DCM now
  Vec2 nominal_dcm = Vec2::Zero();  ///< DCM that the plan wants at touchdown for `planned`
  double transfer = 1.0;            ///< gamma of the double support that follows
  Vec2 ankle = Vec2::Zero();        ///< ZMP from the stance foot until touchdown, reckoned with [m]
};

CatchingLine catching_line(const StepSituation& situation);

struct StepAdjustment {
  Footstep step;              ///< the step to take
  Vec2 error = Vec2::Zero();  ///< Delta_f: how far the plan is from catching the DCM [m]
  bool adjusted = false;      ///< error beyond the compliance margin
};

/// (10'), (11'): f_{i+1} + k_sa Delta_f, always from the plan (nothing accumulates), moved to the
/// nearest step within the limits. `time_left` until touchdown [s].
StepAdjustment adjust_step(const StepSituation& situation, double time_left, double omega,
                           const ReachRegion& reach, const Parameters& parameters);

/// ZMP from the stance foot [m] that until touchdown makes good a foothold that is `error` away
/// from where it should be, as far as the ZMP gets inside `share` of the sole.
Vec2 ankle_help(const StepSituation& situation, const Vec2& error, double time_left, double omega,
                const Sole& sole, double share);

/// (12'): time left until touchdown, in [earliest, latest], at which a reachable foothold catches
/// the DCM: the nominal one if that does, else the nearest that does, else the one with the least
/// distance between the catching foothold and the reachable region.
double adjust_time(const StepSituation& situation, double nominal, double earliest, double latest,
                   double omega, const ReachRegion& reach);

}  // namespace stagger::engine
