#include "server/robot_library.h"

#include <algorithm>

namespace stagger::server {

std::vector<std::string> RobotLibrary::names() const { return sim::list_robots(folder_); }

std::shared_ptr<const sim::Robot> RobotLibrary::find(const std::string& name) {
  // Only a name out of the list ever becomes part of a path.
  const std::vector<std::string> known = names();
  if (std::find(known.begin(), known.end(), name) == known.end()) return nullptr;
  const std::lock_guard lock(mutex_);
  auto& robot = robots_[name];
  if (robot == nullptr) robot = sim::load_robot(folder_ / name);
  return robot;
}

std::string RobotLibrary::unknown(const std::string& name) const {
  std::string list;
  for (const std::string& known : names()) list += (list.empty() ? "" : ", ") + known;
  return "is \"" + name + "\"; robots in " + folder_.string() + ": " +
         (list.empty() ? "none" : list);
}

}  // namespace stagger::server
