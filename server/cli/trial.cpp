#include <iostream>

#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/cli/input.h"
#include "server/json/trial_json.h"
#include "server/robot_library.h"
#include "sim/json_file.h"

namespace stagger::server {
int trial_command(const TrialOptions& options, const Folders& folders) {
  const std::string text = read_input(options.spec);
  const std::string name = options.spec == "-" ? "standard input" : options.spec;
  sim::JsonErrors errors;
  sim::TrialSpec spec;
  std::shared_ptr<const sim::Robot> robot;
  try {
    spec = read_trial(sim::parse_json(text), errors);
  } catch (const sim::JsonSyntaxError& error) {
    std::cerr << name << ':' << error.line << ':' << error.column << ": " << error.what() << '\n';
    return exit_usage;
  }
  if (!spec.robot.empty()) {
    RobotLibrary library(folders.robots, folders.uploaded_robots());
    robot = library.find(spec.robot);
    if (robot == nullptr) {
      errors.add("/robot", library.unknown(spec.robot));
    } else {
      check_for_robot(spec, robot, errors);
    }
  }
  for (const sim::JsonError& error : errors.list()) {
    std::cerr << name << ':' << sim::line_of(text, error.pointer) << ": "
              << (error.pointer.empty() ? "" : error.pointer + " ") << error.text << '\n';
  }
  if (!errors.empty()) return exit_usage;

  const sim::TrialResult result = sim::run_trial(spec, robot);
  std::cout << trial_result_json(result, spec).dump(2) << '\n';
  return result.outcome == sim::TrialOutcome::invalid ? exit_invalid : exit_ok;
}

}  // namespace stagger::server
