// URDF in, RobotModel out.
#pragma once

#include <filesystem>
#include <string>

#include "sim/robot/robot_model.h"

namespace stagger::sim {

/// Builds the model from the text of a URDF. Links held together by fixed joints become one body;
/// a revolute joint with lower >= upper counts as unlimited, because urdfdom reads missing bounds
/// as 0..0. Joint damping and friction are not modelled. `origin` is how errors name the document.
/// Throws std::runtime_error for what is not a tree of revolute joints, for a moving body without
/// mass or with an inertia that is not positive definite, and for mesh collision geometry.
RobotModel import_urdf(const std::string& xml, const std::string& origin);

/// Reads the file and imports it. Throws std::runtime_error.
RobotModel import_urdf_file(const std::filesystem::path& file);

}  // namespace stagger::sim
