#include <chrono>
#include <cmath>
#include <iostream>

#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/json/gait_json.h"
#include "server/json/parameters_json.h"
#include "server/json/terrain_json.h"
#include "sim/simulation.h"

namespace stagger::server {
int run_command(const RunOptions& options, const Folders& folders) {
  RobotLibrary library(folders.robots, folders.uploaded_robots());
  const sim::SimulationConfig config = world_of(options.world, library);
  if (config.robot == nullptr) return exit_usage;
  sim::Simulation simulation(config);
  simulation.walk(options.walk);

  const auto ticks =
      static_cast<std::uint64_t>(std::llround(options.seconds / sim::Simulation::tick_s));
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t i = 0; i < ticks; ++i) {
    simulation.step();
    simulation.take_events();  // nobody listens: they must not pile up
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;

  const sim::Frame& frame = simulation.frame();
  const double seconds = static_cast<double>(ticks) * sim::Simulation::tick_s;
  const double factor = seconds / std::max(wall.count(), 1e-9);
  if (options.json) {
    Json json{
        {"robot", config.robot->name}, {"plant", name_of(config.plant)}, {"seed", config.seed}};
    write_senses(json, config.plant, config.senses);
    json.update({{"seconds", seconds},
                 {"walk", walk_json(options.walk)},
                 {"terrain", terrain_json(config.terrain)},
                 {"parameters", parameter_values_json(config.parameters)},
                 {"ticks", ticks},
                 {"fell", frame.fallen},
                 {"fall_reason", frame.fallen ? Json(simulation.fall_reason()) : Json()},
                 {"steps", frame.step_count},
                 {"distance_m", std::hypot(frame.com.x(), frame.com.y())},
                 {"worst_dcm_error_m", simulation.worst_dcm_error()},
                 {"real_time_factor", factor},
                 {"state_hash", sim::to_hex(simulation.state_hash())},
                 {"version", STAGGER_VERSION}});
    std::cout << json.dump(2) << '\n';
  } else {
    std::cout << options.world.robot << " on " << options.world.plant << ", " << seconds << " s: "
              << (frame.fallen ? "fell: " + simulation.fall_reason() : std::string("stayed up"))
              << "; " << frame.step_count << " steps, worst DCM error "
              << simulation.worst_dcm_error() << " m, " << factor << " x real time\n";
  }
  return frame.fallen ? exit_no : exit_ok;
}

}  // namespace stagger::server
