#include "sim/engine_setup.h"

#include <algorithm>

#include "sim/robot/hip_flywheel.h"

namespace stagger::sim {
engine::Parameters engine_parameters(const Robot& robot, PlantKind plant,
                                     const engine::Strategies& strategies, double tick,
                                     const SenseParameters& senses) {
  const BipedDescription& d = robot.description;
  engine::Parameters p;
  p.tick = tick;
  p.mass = robot.model.mass();
  p.com_height = d.walk.com_height_m;
  p.t_ss = d.walk.t_ss_s;
  p.least_t_ss = std::min(p.least_t_ss, p.t_ss);
  p.t_ds = d.walk.t_ds_s;
  p.t_init = d.walk.t_init_s;
  p.stance_width = d.walk.stance_width_m;
  p.swing_height = d.walk.swing_height_m;
  p.foot_half_length = 0.5 * d.feet[0].sole.length;
  p.foot_half_width = 0.5 * d.feet[0].sole.width;
  p.max_step_length = d.walk.max_step_length_m;
  p.min_step_width = d.walk.min_step_width_m;
  p.max_step_width = d.walk.max_step_width_m;
  p.strategies = strategies;
  p.hip = hip_flywheel(robot);
  // A body that leans as far as it can is worse at stepping: pushed to the side in mid-step kasaei
  // then falls at 0.6 m/s instead of beyond 0.8.
  p.hip.in_steps = plant == PlantKind::lipm;

  if (plant == PlantKind::bullet && !senses.perfect_state) {
    // What the estimated DCM is off by from tick to tick is the joint velocities' noise: 0.4 mm a
    // direction, measured on kasaei. With more process noise the filter lets it through, with less
    // it gains little and is late after a push.
    p.process_noise = 1e-7;
    p.measurement_noise = 1.6e-7;
  } else {
    // The state is told without noise, so the filter follows the measurement closely.
    p.process_noise = 1e-6;
    p.measurement_noise = 1e-8;
  }
  p.step_margin = 0.01;
  // The whole-body controller keeps its corner forces this far inside the sole.
  if (plant == PlantKind::bullet) p.sole_margin = 0.005;
  // A step may come as soon as a leg can swing, and as much later.
  p.time_limit = 0.75 * p.t_ss;
  return p;
}

}  // namespace stagger::sim
