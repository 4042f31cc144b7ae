#include "server/cli/folders.h"

#include <cstdlib>
#include <initializer_list>
#include <system_error>

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

fs::path executable() {
  std::error_code error;
  const fs::path file = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::current_path() / "stagger" : file;
}

fs::path executable_folder() { return executable().parent_path(); }

std::string from_environment(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr ? value : "";
}

fs::path data_folder(const std::string& option) {
  if (!option.empty()) return option;
  if (const std::string own = from_environment("STAGGER_DATA"); !own.empty()) return own;
  // The XDG rules: a path that is not absolute does not count.
  if (const fs::path base = from_environment("XDG_DATA_HOME"); base.is_absolute()) {
    return base / "stagger";
  }
  if (const fs::path home = from_environment("HOME"); home.is_absolute()) {
    return home / ".local/share/stagger";
  }
  return fs::temp_directory_path() / "stagger";
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

Folders find_folders(const std::string& robots_option, const std::string& web_option,
                     const std::string& data_option) {
  return {choose(robots_option, "STAGGER_ROBOTS", {"../../robots", "../share/stagger/robots"}),
          choose(web_option, "STAGGER_WEB", {"../../web/dist", "../share/stagger/web"}),
          data_folder(data_option), executable()};
}

}  // namespace stagger::server
