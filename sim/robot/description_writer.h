// A found biped as a folder of its own.
#pragma once

#include <filesystem>
#include <string>

#include "sim/robot/biped_finder.h"

namespace stagger::sim {

/// robot.json of a description; read_biped_description() reads it back.
std::string description_json(const BipedDescription& biped);

/// Writes robot.json into the folder, with the URDF and its collision meshes beside it, so that
/// load_robot() takes the folder wherever it is moved. Makes the folder; refuses one that has a
/// robot.json already. Throws std::runtime_error that names the file that could not be written.
void write_robot(const BipedFinding& found, const std::filesystem::path& folder);

}  // namespace stagger::sim
