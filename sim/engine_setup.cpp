#include "sim/engine_setup.h"

#include <algorithm>

#include "sim/control/whole_body_gains.h"
#include "sim/robot/dynamic_scale.h"
#include "sim/robot/foot_acceleration.h"
#include "sim/robot/hip_flywheel.h"
#include "sim/robot/legs.h"

namespace stagger::sim {
namespace {

/// Part of the acceleration that a leg has the torque for that a step may be planned with; the rest
/// follows the plan. Of h1_2 that is 70 m/s^2. With 100 its hip gives all it has from a late step's
/// first to its last moment, and the foot ends 0.1 m behind its place: pushed backwards by 0.698
/// m/s in mid-step it then falls in 12 of 50 trials, and in none with 50 or 70.
constexpr double swing_torque_share = 0.85;

}  // namespace

engine::Parameters engine_parameters(const Robot& robot, PlantKind plant,
                                     const engine::Strategies& strategies, double tick,
                                     const SenseParameters& senses) {
  const BipedDescription& d = robot.description;
  const DynamicScale scale = dynamic_scale(robot);
  const double time = scale.time();
  engine::Parameters p;
  p.tick = tick;
  p.mass = robot.model.mass();
  p.com_height = d.walk.com_height_m;
  p.t_ss = d.walk.t_ss_s;
  p.least_t_ss = std::min(p.least_t_ss * time, p.t_ss);
  p.t_ds = d.walk.t_ds_s;
  p.t_init = d.walk.t_init_s;
  p.stance_width = d.walk.stance_width_m;
  p.swing_height = d.walk.swing_height_m;
  p.foot_half_length = 0.5 * d.feet[0].sole.length;
  p.foot_half_width = 0.5 * d.feet[0].sole.width;
  p.foot_clearance *= scale.length;
  p.max_step_length = d.walk.max_step_length_m;
  p.max_step_back = d.walk.max_step_back_m;
  p.min_step_width = d.walk.min_step_width_m;
  p.max_step_width = d.walk.max_step_width_m;
  p.strategies = strategies;
  p.hip = hip_flywheel(robot);
  // A body that leans as far as it can is worse at stepping: pushed to the side in mid-step kasaei
  // then falls at 0.6 m/s instead of beyond 0.8.
  p.hip.in_steps = plant == PlantKind::lipm;

  // Noise is told in lengths; robots of another size have it in proportion.
  const double area = scale.length * scale.length;
  if (plant == PlantKind::bullet && !senses.perfect_state) {
    // What the estimated DCM is off by from tick to tick is the joint velocities' noise: 0.4 mm a
    // direction, measured on kasaei. With more process noise the filter lets it through, with less
    // it gains little and is late after a push.
    p.process_noise = 1e-7 * area;
    p.measurement_noise = 1.6e-7 * area;
  } else {
    // The state is told without noise, so the filter follows the measurement closely.
    p.process_noise = 1e-6 * area;
    p.measurement_noise = 1e-8 * area;
  }
  // The weight of an integral over time is one per squared time.
  p.lqr_state_weight[2] /= time * time;
  p.step_margin = 0.01 * scale.length;
  p.step_freeze *= time;
  // A step may come as soon as a leg can swing, and as much later.
  p.time_limit = 0.75 * p.t_ss;
  p.time_constant *= time;
  p.contact_load *= scale.mass;
  p.landing_patience *= time;
  p.landing_speed *= scale.length / time;
  p.landing_rate /= time;
  p.hold_load *= scale.mass;
  if (plant == PlantKind::bullet) {
    const WholeBodyGains gains = whole_body_gains(robot);
    // The whole-body controller keeps its corner forces this far inside the sole.
    p.sole_margin = gains.sole_margin;
    // With it a push in the last part of a step can still change that step: kasaei then takes 0.8
    // m/s to the side of the swing foot, and 0.6 when it has to land first.
    const double most = gains.swing_acceleration_limit;
    p.swing_acceleration =
        std::clamp(swing_torque_share * foot_acceleration(robot), 0.1 * most, most);
    p.step_anew = 0.1 * scale.length;
    p.ankle_reach = p.ankle_reach.cwiseMin(ankle_zmp_reach(robot, p.gravity));
  }
  return p;
}

}  // namespace stagger::sim
