#include <iomanip>
#include <iostream>

#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/json/parameters_json.h"

namespace stagger::server {

int parameters_command(const ParametersOptions& options, const Folders& folders) {
  RobotLibrary library(folders.robots);
  const sim::SimulationConfig config = world_of(options.world, library);
  if (config.robot == nullptr) return exit_usage;
  const Json table = parameter_table_json(config, {config.parameters, config.parameters});
  if (options.json) {
    std::cout << table.dump(2) << '\n';
    return exit_ok;
  }
  for (const Json& row : table["items"]) {
    const std::string unit = row["unit"].get<std::string>();
    std::cout << std::left << std::setw(34) << row["name"].get<std::string>() << ' '
              << row["value"].dump() << (unit.empty() ? "" : " " + unit);
    if (row.contains("least")) {
      std::cout << "  [" << row["least"].dump() << " to " << row["most"].dump() << ']';
    }
    std::cout << "  " << row["meaning"].get<std::string>() << '\n';
  }
  return exit_ok;
}

}  // namespace stagger::server
