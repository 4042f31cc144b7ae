#include "server/cli/folders.h"

#include <cstdlib>
#include <initializer_list>
#include <system_error>

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

fs::path executable_folder() {
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::current_path() : executable.parent_path();
}

fs::path choose(const std::string& option, const char* variable,
                std::initializer_list<fs::path> beside_executable) {
  if (!option.empty()) return option;
  if (const char* value = std::getenv(variable); value != nullptr && *value != '\0') return value;
  for (const fs::path& candidate : beside_executable) {
    const fs::path folder = executable_folder() / candidate;
    std::error_code error;
    if (fs::is_directory(folder, error)) return folder.lexically_normal();
  }
  return (executable_folder() / *beside_executable.begin()).lexically_normal();
}

}  // namespace

Folders find_folders(const std::string& robots_option, const std::string& web_option) {
  return {choose(robots_option, "STAGGER_ROBOTS", {"../../robots", "../share/stagger/robots"}),
          choose(web_option, "STAGGER_WEB", {"../../web/dist", "../share/stagger/web"})};
}

}  // namespace stagger::server
