#include <fstream>
#include <iostream>
#include <iterator>

#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/json/robot_json.h"
#include "server/json/trial_json.h"
#include "server/robot_library.h"
#include "sim/json_file.h"

namespace stagger::server {
namespace {

std::string read_all(const std::string& file) {
  const auto all = [](std::istream& in) {
    return std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  };
  if (file == "-") return all(std::cin);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file);
  return all(in);
}

}  // namespace

int trial_command(const TrialOptions& options, const Folders& folders) {
  const std::string text = read_all(options.spec);
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
    RobotLibrary library(folders.robots);
    robot = library.find(spec.robot);
    if (robot == nullptr) {
      errors.add("/robot", library.unknown(spec.robot));
    } else if (spec.push) {
      if (const auto wrong = check_link(spec.push->link, *robot)) errors.add("/push/link", *wrong);
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
