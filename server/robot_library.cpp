#include "server/robot_library.h"

#include <algorithm>

namespace stagger::server {
namespace {

bool is_one_of(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string> RobotLibrary::names() const {
  std::vector<std::string> all = sim::list_robots(folder_);
  for (std::string& name : sim::list_robots(uploads_)) all.push_back(std::move(name));
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::shared_ptr<const sim::Robot> RobotLibrary::find(const std::string& name) {
  // Only a name out of the list ever becomes part of a path.
  const std::lock_guard lock(mutex_);
  const bool shipped = is_one_of(name, sim::list_robots(folder_));
  if (!shipped && !is_one_of(name, sim::list_robots(uploads_))) return nullptr;
  auto& robot = robots_[name];
  if (robot == nullptr) {
    robot = sim::load_robot((shipped ? folder_ : uploads_) / name);
  }
  return robot;
}

bool RobotLibrary::is_uploaded(const std::string& name) const {
  return is_one_of(name, sim::list_robots(uploads_)) && !is_one_of(name, sim::list_robots(folder_));
}

void RobotLibrary::add_upload(const std::filesystem::path& folder, const std::string& name) {
  const std::lock_guard lock(mutex_);
  std::filesystem::create_directories(uploads_);
  std::filesystem::rename(folder, uploads_ / name);
  robots_.erase(name);
}

void RobotLibrary::remove_upload(const std::string& name) {
  const std::lock_guard lock(mutex_);
  // Its description first: without it the folder is no robot, whatever happens next.
  std::filesystem::remove(uploads_ / name / "robot.json");
  robots_.erase(name);
  std::filesystem::remove_all(uploads_ / name);
}

std::string RobotLibrary::unknown(const std::string& name) const {
  std::string list;
  for (const std::string& known : names()) list += (list.empty() ? "" : ", ") + known;
  return "is \"" + name + "\"; robots in " + folder_.string() + ": " +
         (list.empty() ? "none" : list);
}

}  // namespace stagger::server
