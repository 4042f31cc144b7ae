#include "engine/step_adjuster.h"

#include "engine/footstep_planner.h"
#include "engine/lipm.h"

namespace stagger::engine {

StepAdjustment adjust_step(const StepSituation& situation, double omega,
                           const Parameters& parameters) {
  StepAdjustment result;
  result.step = situation.planned;
  const Vec2 touchdown_dcm =
      dcm_after(situation.dcm, situation.stance.position, situation.time_left, omega);
  result.error = (touchdown_dcm - situation.nominal_dcm) / situation.transfer;  // (10')
  result.adjusted = result.error.norm() > parameters.step_margin;
  if (result.adjusted) {
    const Vec2 wanted = situation.planned.position + parameters.step_gain * result.error;  // (11')
    result.step.position = clamp_to_reach(situation.stance, wanted, parameters);
  }
  return result;
}

}  // namespace stagger::engine
