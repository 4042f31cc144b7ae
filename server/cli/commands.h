// The commands, one file each. All return the process's exit code.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/parameters.h"
#include "server/cli/folders.h"
#include "server/json/json.h"
#include "server/json/senses_json.h"
#include "server/robot_library.h"
#include "sim/simulation.h"

namespace stagger::server {

inline const sim::SenseParameters default_senses;

/// The world that `serve` and `run` build.
struct WorldOptions {
  std::string robot;
  std::string plant = "bullet";
  std::uint64_t seed = 1;
  std::string state{name_of_state(default_senses)};
  std::int64_t control_delay_ms = server::control_delay_ms(default_senses);
  std::string terrain = "flat";              ///< as parse_terrain() reads it
  std::vector<std::string> parameters = {};  ///< name=value
};

struct ServeOptions {
  WorldOptions world{.robot = "kasaei"};
  bool stand = false;
  std::string host = "127.0.0.1";
  int port = 8080;
  std::string api_key_file;        ///< empty: none
  std::string read_only_key_file;  ///< empty: none
  std::vector<std::string> allow_hosts;
  std::vector<std::string> allow_origins;
  std::size_t stream_clients = 64;
  std::string data;             ///< folder of what users make; empty: as find_folders() finds it
  double quota_gb = 10.0;       ///< of recordings [GB]
  double command_rate = 500.0;  ///< [1/s]
  std::string log_level = "info";
  std::string config;         ///< file of settings; empty: none
  bool check_config = false;  ///< print `settings` and exit
  Json settings;              ///< what has come of command line, environment and file
};

struct RunOptions {
  WorldOptions world;
  double seconds = 60.0;
  engine::WalkCommand walk;
  bool json = false;
};

struct ReplayOptions {
  std::string file;
  bool json = false;
};

struct TrialOptions {
  std::string spec;  ///< a file, or "-" for standard input
};

struct ParametersOptions {
  WorldOptions world{.robot = "kasaei"};
  bool json = false;
};

struct RobotsOptions {
  bool json = false;
};

struct RobotsCheckOptions {
  std::string urdf;
  std::string write;  ///< folder to write a description to; empty: none
  bool json = false;
  bool load = false;       ///< the URDF's folder is to be a robot, by its own description
  bool untrusted = false;  ///< the check itself may cost little
};

struct PaperOptions {
  std::string section;  ///< "plan", "lqg", "scenario1", "scenario2", "robustness"; empty: all
  bool json = false;
  std::string out;  ///< folder of the report; empty: none
  int seeds = 20;
  std::optional<double> t_ss;           ///< [s]
  std::optional<double> t_ds;           ///< [s]
  std::optional<double> t_left;         ///< [s]
  std::optional<double> direction_deg;  ///< 0 forward, 90 to the left
};

struct LimitsOptions {
  WorldOptions world;  ///< its seed is the first of them
  int seeds = 20;
  std::string directions = "0:315:45";  ///< list [degrees]
  std::string phases = "0.1,0.35,0.6,0.85";
  std::string leg = "left";
  std::string durations = "0.01";  ///< list [s]
  std::string strategies = "ankle,hip,step,time";
  std::string link;  ///< empty: the robot's torso
  engine::WalkCommand walk;
  double from = 0.1;           ///< lowest rung [m/s]
  double to = 1.2;             ///< highest rung [m/s]
  double step = 0.05;          ///< between two rungs [m/s]
  std::optional<double> gate;  ///< in place of `to`: all have to pass [m/s]
  double settle_s = 3.0;
  double observe_s = 6.0;
  double recover_s = 4.0;
  unsigned threads = 0;  ///< 0: one a core
  bool json = false;
  bool quiet = false;
  std::string out;       ///< file for the JSON; empty: none
  std::string markdown;  ///< file for the page; empty: none
  std::string command;   ///< as it was typed, for the page
};

/// The configuration; its robot is null, after a message on standard error, when there is none of
/// that name, or when the terrain or the parameters cannot be.
sim::SimulationConfig world_of(const WorldOptions& options, RobotLibrary& robots);

/// Serves the dashboard, the API and the stream until SIGTERM or SIGINT.
int serve_command(const ServeOptions& options, const Folders& folders);
/// Walks without a server, as fast as possible.
int run_command(const RunOptions& options, const Folders& folders);
/// One trial from its specification.
int trial_command(const TrialOptions& options, const Folders& folders);
/// Lists the parameters of a robot.
int parameters_command(const ParametersOptions& options, const Folders& folders);
/// Runs a recording again and compares every tick; exit_no when one differs.
int replay_command(const ReplayOptions& options, const Folders& folders);
/// Lists the robots.
int robots_command(const RobotsOptions& options, const Folders& folders);
/// Finds the biped in a URDF and tells what was found; exit_no for what cannot walk.
int robots_check_command(const RobotsCheckOptions& options);
/// The paper's experiments beside what it publishes and beside the ceilings.
int paper_command(const PaperOptions& options);

/// Push limits of a robot over directions, phases and durations.
int limits_command(const LimitsOptions& options, const Folders& folders);

}  // namespace stagger::server
