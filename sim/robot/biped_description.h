// What a URDF does not say about a biped: which links are its feet, how it stands, how it walks.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "engine/types.h"
#include "sim/robot/urdf_import.h"

namespace stagger::sim {

class JsonReader;

/// The rectangle that a foot stands on, in the frame of the foot's link: its length runs along the
/// sole's x axis, to the toes, and its plane is normal to the sole's z axis, which points up.
struct SoleDescription {
  engine::Vec3 position = engine::Vec3::Zero();  ///< centre [m]
  engine::Vec3 rpy = engine::Vec3::Zero();       ///< of the sole's axes, as in a URDF [rad]
  double length = 0.0;                           ///< [m]
  double width = 0.0;                            ///< [m]
};

struct FootDescription {
  std::string link;
  SoleDescription sole;
};

/// Walking parameters that suit this robot; they fill the engine's Parameters.
struct WalkDescription {
  double com_height_m = 0.0;  ///< above the soles, while walking
  double stance_width_m = 0.0;
  double swing_height_m = 0.0;
  double t_ss_s = 0.0;
  double t_ds_s = 0.0;
  double t_init_s = 0.0;
  double max_step_length_m = 0.0;  ///< forward
  double max_step_back_m = 0.0;
  double min_step_width_m = 0.0;
  double max_step_width_m = 0.0;
};

/// The same as a description gives them; what it leaves out follows by formula (walk_defaults.h).
struct GivenWalk {
  std::optional<double> com_height_m;
  std::optional<double> stance_width_m;
  std::optional<double> swing_height_m;
  std::optional<double> t_ss_s;
  std::optional<double> t_ds_s;
  std::optional<double> t_init_s;
  std::optional<double> max_step_length_m;
  std::optional<double> max_step_back_m;
  std::optional<double> min_step_width_m;
  std::optional<double> max_step_width_m;

  /// `defaults` with what is given in their place.
  WalkDescription over(const WalkDescription& defaults) const;
};

/// robots/<name>/robot.json
struct BipedDescription {
  int version = 1;
  std::string urdf;   ///< file beside robot.json
  std::string base;   ///< link whose yaw is the robot's heading
  std::string torso;  ///< link that is kept upright and that pushes act on by default
  engine::Vec3 torso_rpy = engine::Vec3::Zero();  ///< of its axes forward, left, up, in its frame
  engine::PerFoot<FootDescription> feet;
  std::map<std::string, double> nominal_pose;  ///< joint -> angle [rad]; joints not named are at 0
  std::map<std::string, double> locked;        ///< joint -> where it is held for good [rad]
  std::map<std::string, MotorLimits> motors;   ///< joint -> what replaces the URDF's limits
  bool mend = false;                           ///< the URDF is imported with ImportMode::mend
  GivenWalk given_walk;
  WalkDescription walk;  ///< complete: load_robot() fills it
};

/// Rotation of roll, pitch, yaw about fixed axes, as a URDF means it.
Eigen::Matrix3d rotation_of(const engine::Vec3& rpy);

/// Reads robot.json. Links and joints are only names here: load_robot() checks them against the
/// URDF. Throws std::runtime_error with every error found: file, line, field, value, allowed range.
BipedDescription read_biped_description(const std::filesystem::path& file);

/// The same from a reader that stands at the root of the description.
BipedDescription read_biped_description(JsonReader& reader);

}  // namespace stagger::sim
