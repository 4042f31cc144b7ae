#include <iomanip>
#include <iostream>

#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/json/robot_json.h"
#include "server/robot_library.h"

namespace stagger::server {

int robots_command(const RobotsOptions& options, const Folders& folders) {
  RobotLibrary library(folders.robots, folders.uploaded_robots());
  Json items = Json::array();
  for (const std::string& name : library.names()) {
    const auto robot = library.find(name);
    if (options.json) {
      items.push_back(robot_json(*robot));
    } else {
      std::cout << std::left << std::setw(16) << name << std::right << std::fixed
                << std::setprecision(1) << std::setw(6) << robot->model.mass() << " kg "
                << std::setw(4) << robot->model.joint_count() << " joints\n";
    }
  }
  if (options.json) std::cout << Json{{"items", std::move(items)}}.dump(2) << '\n';
  return exit_ok;
}

}  // namespace stagger::server
