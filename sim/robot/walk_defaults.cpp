#include "sim/robot/walk_defaults.h"

#include <algorithm>
#include <cmath>

#include "sim/robot/legs.h"
#include "sim/robot/posture.h"
#include "sim/robot/rigid_body.h"

namespace stagger::sim {
namespace {

using engine::Side;

// Anchor: robot kasaei, for whom these were chosen by push sweeps. Times at h = 1 m [s].
constexpr double default_t_ss = 0.36;
constexpr double default_t_ds = 0.04;
constexpr double default_t_init = 0.6;
// Shares of the leg's length. Kasaei's legs are 1 m long: these are its lengths in metres.
constexpr double default_swing_height = 0.05;
// Who is pushed while walking has a step more to make: with up to 0.6 h1_2 falls at 0.3 m/s forward
// from pushes forward that it takes with this. In place nobody loses anything, so long as the trunk
// is held (torso_weight): with 0.5 h1_2 fell from some that it takes with a shorter step.
constexpr double longest_step = 0.64;
// A longer one catches a harder push of a pendulum. A body's swing leg turns its trunk the other
// way and the hips with it, and a foot put down farther back lands on a straight knee: with 0.7 g1
// falls from 0.4 m/s, with 0.45 from a push to 165 deg that it takes with this.
constexpr double longest_step_back = 0.42;
constexpr double sole_gap = 0.025;     // least, between the soles of feet side by side
constexpr double widest_extra = 0.50;  // beyond the stance width

}  // namespace

BipedProportions biped_proportions(const Robot& robot) {
  RigidBody body(robot.model);
  body.update(nominal_state(robot));
  BipedProportions p;
  p.leg_length = leg_length(body, robot);
  body.update(lowered_state(
      robot, [&](const RigidBody& now) { return hip_height(now, robot); },
      walking_hip_share * p.leg_length));
  p.com_height = body.com().z();
  p.hip_height = hip_height(body, robot);
  p.sole_width = robot.description.feet[0].sole.width;
  p.stance_width = (sole_centre(body, robot, Side::left) - sole_centre(body, robot, Side::right))
                       .head<2>()
                       .norm();
  return p;
}

WalkDescription walk_defaults(const BipedProportions& p) {
  const double time = std::sqrt(p.com_height);
  WalkDescription walk;
  walk.com_height_m = p.com_height;
  const double least_width = p.sole_width + sole_gap * p.leg_length;
  walk.stance_width_m = std::max(p.stance_width, least_width);
  walk.swing_height_m = default_swing_height * p.leg_length;
  walk.t_ss_s = default_t_ss * time;
  walk.t_ds_s = default_t_ds * time;
  walk.t_init_s = default_t_init * time;
  // Both legs straight, with the hips as high as in walking half-way between the feet.
  const double spread =
      std::sqrt(std::max(p.leg_length * p.leg_length - p.hip_height * p.hip_height, 0.0));
  walk.max_step_length_m = std::min(longest_step * p.leg_length, 2.0 * spread);
  walk.max_step_back_m = std::min(longest_step_back * p.leg_length, 2.0 * spread);
  walk.min_step_width_m = least_width;
  walk.max_step_width_m = walk.stance_width_m + widest_extra * p.leg_length;
  return walk;
}

}  // namespace stagger::sim
