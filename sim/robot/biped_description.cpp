#include "sim/robot/biped_description.h"

#include "engine/parameters.h"
#include "sim/json_file.h"
#include "sim/strict_json.h"

namespace stagger::sim {
namespace {

FootDescription read_foot(JsonReader& in) {
  FootDescription foot;
  foot.link = in.string("link");
  in.object("sole", [&](JsonReader& sole) {
    foot.sole.position = sole.vec3("position", Range::between(-1.0, 1.0, "m"));
    foot.sole.length = sole.number("length", Range::between(0.02, 1.0, "m"));
    foot.sole.width = sole.number("width", Range::between(0.02, 1.0, "m"));
  });
  return foot;
}

/// `sole_width`: of each foot [m].
WalkDescription read_walk(JsonReader& in, double sole_width) {
  WalkDescription walk;
  walk.com_height_m = in.number("com_height_m", Range::between(0.05, 3.0, "m"));
  walk.stance_width_m = in.number("stance_width_m", Range::between(0.02, 1.0, "m"));
  walk.swing_height_m = in.number("swing_height_m", Range::between(0.005, 0.5, "m"));
  walk.t_ss_s = in.number("t_ss_s", Range::between(0.1, 3.0, "s"));
  walk.t_ds_s = in.number("t_ds_s", Range::between(0.0, 2.0, "s"));
  walk.t_init_s = in.number("t_init_s", Range::between(0.1, 5.0, "s"));
  walk.max_step_length_m = in.number("max_step_length_m", Range::between(0.01, 2.0, "m"));
  walk.min_step_width_m = in.number("min_step_width_m", Range::between(0.0, 1.0, "m"));
  walk.max_step_width_m = in.number("max_step_width_m", Range::between(0.02, 2.0, "m"));
  if (walk.min_step_width_m < sole_width + engine::Parameters().foot_clearance) {
    in.refuse("min_step_width_m",
              "leaves no gap between the soles; allowed: at least the sole's width and 0.01 m");
  }
  if (walk.min_step_width_m > walk.stance_width_m) {
    in.refuse("min_step_width_m", "is greater than stance_width_m; allowed: at most that");
  }
  if (walk.max_step_width_m < walk.stance_width_m) {
    in.refuse("max_step_width_m", "is less than stance_width_m; allowed: at least that");
  }
  return walk;
}

}  // namespace

BipedDescription read_biped_description(JsonReader& in) {
  BipedDescription biped;
  biped.version = static_cast<int>(in.integer("version", Range::between(1, 1)));
  biped.urdf = in.string("urdf");
  biped.base = in.string("base");
  biped.torso = in.string("torso");
  in.object("feet", [&](JsonReader& feet) {
    feet.object("left", [&](JsonReader& foot) { biped.feet[0] = read_foot(foot); });
    feet.object("right", [&](JsonReader& foot) { biped.feet[1] = read_foot(foot); });
  });
  biped.nominal_pose = in.numbers("nominal_pose", Range::between(-6.3, 6.3, "rad"));
  in.object("walk",
            [&](JsonReader& walk) { biped.walk = read_walk(walk, biped.feet[0].sole.width); });
  return biped;
}

BipedDescription read_biped_description(const std::filesystem::path& file) {
  BipedDescription biped;
  read_json_file(file, [&](JsonReader& in) { biped = read_biped_description(in); });
  return biped;
}

}  // namespace stagger::sim
