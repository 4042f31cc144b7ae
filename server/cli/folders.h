// Where the robots and the dashboard are, and where what users make is kept.
#pragma once

#include <filesystem>
#include <string>

namespace stagger::server {

struct Folders {
  std::filesystem::path robots;
  std::filesystem::path web;         ///< the built dashboard; need not exist
  std::filesystem::path data;        ///< what users make; made when it is needed
  std::filesystem::path executable;  ///< this program

  std::filesystem::path uploaded_robots() const { return data / "robots"; }
};

/// Each from the option when it is not empty, else from the environment (STAGGER_ROBOTS,
/// STAGGER_WEB, STAGGER_DATA), else beside the executable: in the build tree, then in an
/// installation; the data folder else in $XDG_DATA_HOME/stagger or ~/.local/share/stagger.
Folders find_folders(const std::string& robots_option, const std::string& web_option,
                     const std::string& data_option);

}  // namespace stagger::server
