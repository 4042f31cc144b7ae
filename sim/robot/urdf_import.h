// URDF in, RobotModel out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "sim/robot/quirk.h"
#include "sim/robot/robot_model.h"

namespace stagger::sim {

/// What a motor really gives, where a URDF does not say it.
struct MotorLimits {
  std::optional<double> effort;    ///< greatest |torque| [N m]
  std::optional<double> velocity;  ///< greatest |joint velocity| [rad/s]
};

enum class ImportMode : std::uint8_t {
  strict,  ///< whatever could not be simulated as it is written is an error
  mend,    ///< missing masses and inertias are filled in, missing meshes and empty shapes left out
  survey   ///< as mend; joints that do not turn are held, joints that mimic others taken as free
};

struct ImportOptions {
  ImportMode mode = ImportMode::strict;
  std::filesystem::path folder;               ///< of the URDF: where its meshes are looked for
  std::map<std::string, double> locked;       ///< joint -> where it is held for good [rad]
  std::map<std::string, MotorLimits> motors;  ///< joint -> what replaces the URDF's limits
};

struct HeldJoint {
  std::string type;
  int body = 0;  ///< that it holds together
};

/// What a survey has to tell beside the model.
struct ImportReport {
  Quirks quirks;
  Quirks mended;                                        ///< what was filled in for moving bodies
  std::map<std::string, std::string> mimics;            ///< joint -> the joint that it follows
  std::map<std::string, HeldJoint> held;                ///< joints that do not turn
  std::map<std::string, std::filesystem::path> meshes;  ///< URI of a collision mesh -> its file
};

/// Builds the model from the text of a URDF. Links held together by fixed and locked joints become
/// one body; a floating joint below a root without mass counts as fixed, for the base floats
/// anyway. A revolute joint with lower >= upper counts as unlimited, because urdfdom reads missing
/// bounds as 0..0. A mesh becomes the hull of at most 32 of its points. Joint damping and friction
/// are not modelled. `origin` is how errors name the document; the report is filled when it is
/// given. Throws std::runtime_error for what is not a tree of revolute joints, for a name in
/// `options` that is no joint, and, when strict, for a moving body without mass or with an inertia
/// that no body has, and for a mesh without its file.
RobotModel import_urdf(const std::string& xml, const std::string& origin,
                       const ImportOptions& options = {}, ImportReport* report = nullptr);

/// Reads the file and imports it; meshes are looked for from the file's own folder. Throws
/// std::runtime_error.
RobotModel import_urdf_file(const std::filesystem::path& file, ImportOptions options = {},
                            ImportReport* report = nullptr);

}  // namespace stagger::sim
