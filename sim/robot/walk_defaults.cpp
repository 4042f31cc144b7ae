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
constexpr double t_ss = 0.36;
constexpr double t_ds = 0.04;
constexpr double t_init = 0.6;
// Shares of the leg's length. Kasaei's legs are 1 m long: these are its lengths in metres.
constexpr double swing_height = 0.05;
constexpr double longest_step = 0.7;
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
  walk.swing_height_m = swing_height * p.leg_length;
  walk.t_ss_s = t_ss * time;
  walk.t_ds_s = t_ds * time;
  walk.t_init_s = t_init * time;
  // Both legs straight, with the hips as high as in walking half-way between the feet.
  const double spread =
      std::sqrt(std::max(p.leg_length * p.leg_length - p.hip_height * p.hip_height, 0.0));
  walk.max_step_length_m = std::min(longest_step * p.leg_length, 2.0 * spread);
  walk.min_step_width_m = least_width;
  walk.max_step_width_m = walk.stance_width_m + widest_extra * p.leg_length;
  return walk;
}

}  // namespace stagger::sim
