// Where the robots and the dashboard are.
#pragma once

#include <filesystem>
#include <string>

namespace stagger::server {

struct Folders {
  std::filesystem::path robots;
  std::filesystem::path web;  ///< the built dashboard; need not exist
};

/// Each from the option when it is not empty, else from the environment (STAGGER_ROBOTS,
/// STAGGER_WEB), else beside the executable: in the build tree, then in an installation.
Folders find_folders(const std::string& robots_option, const std::string& web_option);

}  // namespace stagger::server
