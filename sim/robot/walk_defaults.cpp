#include "sim/robot/walk_defaults.h"

#include <algorithm>
#include <cmath>

namespace stagger::sim {
namespace {

// Anchor: robot kasaei, for whom these were chosen by push sweeps. Times at h = 1 m [s].
constexpr double t_ss = 0.40;
constexpr double t_ds = 0.10;
constexpr double t_init = 0.6;
// Shares of the leg's length. Kasaei's legs are 1 m long: these are its lengths in metres.
constexpr double swing_height = 0.05;
constexpr double longest_step = 0.7;
constexpr double sole_gap = 0.025;     // least, between the soles of feet side by side
constexpr double widest_extra = 0.40;  // beyond the stance width

}  // namespace

WalkDescription walk_defaults(const BipedProportions& p) {
  const double time = std::sqrt(p.com_height);
  WalkDescription walk;
  walk.com_height_m = p.com_height;
  walk.stance_width_m = p.stance_width;
  walk.swing_height_m = swing_height * p.leg_length;
  walk.t_ss_s = t_ss * time;
  walk.t_ds_s = t_ds * time;
  walk.t_init_s = t_init * time;
  // Both legs straight, with the hips as high as in the nominal pose half-way between the feet.
  const double spread =
      std::sqrt(std::max(p.leg_length * p.leg_length - p.hip_height * p.hip_height, 0.0));
  walk.max_step_length_m = std::min(longest_step * p.leg_length, 2.0 * spread);
  walk.min_step_width_m = std::min(p.sole_width + sole_gap * p.leg_length, p.stance_width);
  walk.max_step_width_m = p.stance_width + widest_extra * p.leg_length;
  return walk;
}

WalkDescription walk_defaults(const Robot& robot) {
  return walk_defaults(biped_proportions(robot));
}

}  // namespace stagger::sim
