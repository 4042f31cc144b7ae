#include "sim/robot/description_writer.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/robot/mesh_file.h"

namespace stagger::sim {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// To a tenth of a millimetre or millisecond: these numbers are for people to edit.
double readable(double value) { return 1e-4 * std::round(1e4 * value); }

Json foot_json(const FootDescription& foot) {
  Json sole = {{"position", to_json(foot.sole.position)}};
  if (!foot.sole.rpy.isZero(0.0)) sole["rpy"] = to_json(foot.sole.rpy);
  sole["length"] = foot.sole.length;
  sole["width"] = foot.sole.width;
  return {{"link", foot.link}, {"sole", std::move(sole)}};
}

Json motors_json(const std::map<std::string, MotorLimits>& motors) {
  Json result = Json::object();
  for (const auto& [joint, limits] : motors) {
    if (limits.effort) result["effort_nm"][joint] = *limits.effort;
    if (limits.velocity) result["velocity_rad_s"][joint] = *limits.velocity;
  }
  return result;
}

void copy_over(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  if (!error) fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
  if (error) {
    throw std::runtime_error("cannot copy " + from.string() + " to " + to.string() + ": " +
                             error.message());
  }
}

}  // namespace

std::string description_json(const BipedDescription& biped) {
  const WalkDescription& walk = biped.walk;
  Json json = {{"version", biped.version},
               {"urdf", biped.urdf},
               {"mend", biped.mend},
               {"base", biped.base},
               {"torso", biped.torso}};
  if (!biped.torso_rpy.isZero(0.0)) json["torso_rpy"] = to_json(biped.torso_rpy);
  json["feet"] = {{"left", foot_json(biped.feet[0])}, {"right", foot_json(biped.feet[1])}};
  json["nominal_pose"] = biped.nominal_pose;
  if (!biped.locked.empty()) json["locked"] = biped.locked;
  if (!biped.motors.empty()) json["motors"] = motors_json(biped.motors);
  json["walk"] = {{"com_height_m", readable(walk.com_height_m)},
                  {"stance_width_m", readable(walk.stance_width_m)},
                  {"swing_height_m", readable(walk.swing_height_m)},
                  {"t_ss_s", readable(walk.t_ss_s)},
                  {"t_ds_s", readable(walk.t_ds_s)},
                  {"t_init_s", readable(walk.t_init_s)},
                  {"max_step_length_m", readable(walk.max_step_length_m)},
                  {"max_step_back_m", readable(walk.max_step_back_m)},
                  {"min_step_width_m", readable(walk.min_step_width_m)},
                  {"max_step_width_m", readable(walk.max_step_width_m)}};
  return json.dump(2) + "\n";
}

void write_robot(const BipedFinding& found, const fs::path& folder) {
  const fs::path file = folder / "robot.json";
  std::error_code error;
  if (fs::exists(file, error)) {
    throw std::runtime_error(file.string() + " exists already: it may hold corrections by hand");
  }
  fs::create_directories(folder, error);
  if (!fs::equivalent(found.urdf, folder / found.urdf.filename(), error)) {
    copy_over(found.urdf, folder / found.urdf.filename());
  }
  for (const auto& [uri, mesh] : found.meshes) {
    const fs::path place = folder / mesh_place(uri);
    if (!fs::equivalent(mesh, place, error)) copy_over(mesh, place);
  }
  std::ofstream out(file, std::ios::binary);
  out << description_json(found.robot.description);
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace stagger::sim
