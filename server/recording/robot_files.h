// A robot's files as one number: has it changed since?
#pragma once

#include <filesystem>
#include <string>

namespace stagger::server {

/// Hash over the names and contents of all files of the folder, 16 hexadecimal digits; "" when they
/// cannot be read. Tells apart what is different by mistake, not by intent.
std::string robot_files_hash(const std::filesystem::path& folder);

}  // namespace stagger::server
