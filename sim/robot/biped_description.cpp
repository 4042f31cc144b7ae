#include "sim/robot/biped_description.h"

#include "sim/json_file.h"
#include "sim/strict_json.h"

namespace stagger::sim {
namespace {

const Range any_angle = Range::between(-6.3, 6.3, "rad");

FootDescription read_foot(JsonReader& in) {
  FootDescription foot;
  foot.link = in.string("link");
  in.object("sole", [&](JsonReader& sole) {
    foot.sole.position = sole.vec3("position", Range::between(-1.0, 1.0, "m"));
    foot.sole.rpy = sole.vec3_or("rpy", engine::Vec3::Zero(), any_angle);
    foot.sole.length = sole.number("length", Range::between(0.02, 1.0, "m"));
    foot.sole.width = sole.number("width", Range::between(0.02, 1.0, "m"));
  });
  return foot;
}

std::map<std::string, MotorLimits> read_motors(JsonReader& in) {
  std::map<std::string, MotorLimits> motors;
  if (in.has("effort_nm")) {
    const auto efforts = in.numbers("effort_nm", Range::more_than_up_to(0.0, 1e4, "N m"));
    for (const auto& [joint, effort] : efforts) motors[joint].effort = effort;
  }
  if (in.has("velocity_rad_s")) {
    const auto speeds = in.numbers("velocity_rad_s", Range::more_than_up_to(0.0, 1e3, "rad/s"));
    for (const auto& [joint, speed] : speeds) motors[joint].velocity = speed;
  }
  return motors;
}

GivenWalk read_walk(JsonReader& in) {
  GivenWalk walk;
  walk.com_height_m = in.optional_number("com_height_m", Range::between(0.05, 3.0, "m"));
  walk.stance_width_m = in.optional_number("stance_width_m", Range::between(0.02, 1.0, "m"));
  walk.swing_height_m = in.optional_number("swing_height_m", Range::between(0.005, 0.5, "m"));
  walk.t_ss_s = in.optional_number("t_ss_s", Range::between(0.1, 3.0, "s"));
  walk.t_ds_s = in.optional_number("t_ds_s", Range::between(0.0, 2.0, "s"));
  walk.t_init_s = in.optional_number("t_init_s", Range::between(0.1, 5.0, "s"));
  walk.max_step_length_m = in.optional_number("max_step_length_m", Range::between(0.01, 2.0, "m"));
  walk.max_step_back_m = in.optional_number("max_step_back_m", Range::between(0.01, 2.0, "m"));
  walk.min_step_width_m = in.optional_number("min_step_width_m", Range::between(0.0, 1.0, "m"));
  walk.max_step_width_m = in.optional_number("max_step_width_m", Range::between(0.02, 2.0, "m"));
  return walk;
}

}  // namespace

WalkDescription GivenWalk::over(const WalkDescription& defaults) const {
  WalkDescription walk;
  walk.com_height_m = com_height_m.value_or(defaults.com_height_m);
  walk.stance_width_m = stance_width_m.value_or(defaults.stance_width_m);
  walk.swing_height_m = swing_height_m.value_or(defaults.swing_height_m);
  walk.t_ss_s = t_ss_s.value_or(defaults.t_ss_s);
  walk.t_ds_s = t_ds_s.value_or(defaults.t_ds_s);
  walk.t_init_s = t_init_s.value_or(defaults.t_init_s);
  walk.max_step_length_m = max_step_length_m.value_or(defaults.max_step_length_m);
  walk.max_step_back_m = max_step_back_m.value_or(defaults.max_step_back_m);
  walk.min_step_width_m = min_step_width_m.value_or(defaults.min_step_width_m);
  walk.max_step_width_m = max_step_width_m.value_or(defaults.max_step_width_m);
  return walk;
}

Eigen::Matrix3d rotation_of(const engine::Vec3& rpy) {
  if (rpy.isZero(0.0)) return Eigen::Matrix3d::Identity();
  return (Eigen::AngleAxisd(rpy.z(), engine::Vec3::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), engine::Vec3::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), engine::Vec3::UnitX()))
      .toRotationMatrix();
}

BipedDescription read_biped_description(JsonReader& in) {
  BipedDescription biped;
  biped.version = static_cast<int>(in.integer("version", Range::between(1, 1)));
  biped.urdf = in.string("urdf");
  biped.base = in.string("base");
  biped.torso = in.string("torso");
  biped.torso_rpy = in.vec3_or("torso_rpy", engine::Vec3::Zero(), any_angle);
  in.object("feet", [&](JsonReader& feet) {
    feet.object("left", [&](JsonReader& foot) { biped.feet[0] = read_foot(foot); });
    feet.object("right", [&](JsonReader& foot) { biped.feet[1] = read_foot(foot); });
  });
  biped.nominal_pose = in.numbers("nominal_pose", any_angle);
  if (in.has("locked")) biped.locked = in.numbers("locked", any_angle);
  in.optional_object("motors", [&](JsonReader& motors) { biped.motors = read_motors(motors); });
  biped.mend = in.boolean_or("mend", false);
  in.optional_object("walk", [&](JsonReader& walk) { biped.given_walk = read_walk(walk); });
  return biped;
}

BipedDescription read_biped_description(const std::filesystem::path& file) {
  BipedDescription biped;
  read_json_file(file, [&](JsonReader& in) { biped = read_biped_description(in); });
  return biped;
}

}  // namespace stagger::sim
