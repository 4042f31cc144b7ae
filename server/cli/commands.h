// The commands, one file each. All return the process's exit code.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/parameters.h"
#include "server/cli/folders.h"
#include "sim/plant/plant.h"

namespace stagger::server {

struct ServeOptions {
  std::string robot = "kasaei";
  std::string plant = "bullet";
  std::uint64_t seed = 1;
  bool stand = false;
  std::string host = "127.0.0.1";
  int port = 8080;
  bool allow_remote = false;
  std::size_t stream_clients = 64;
  std::string log_level = "info";
};

struct RunOptions {
  std::string robot;
  std::string plant = "bullet";
  std::uint64_t seed = 1;
  double seconds = 60.0;
  engine::WalkCommand walk;
  bool json = false;
};

struct TrialOptions {
  std::string spec;  ///< a file, or "-" for standard input
};

struct RobotsOptions {
  bool json = false;
};

struct RobotsCheckOptions {
  std::string urdf;
  std::string write;  ///< folder to write a description to; empty: none
  bool json = false;
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

/// Serves the dashboard, the API and the stream until SIGTERM or SIGINT.
int serve_command(const ServeOptions& options, const Folders& folders);
/// Walks without a server, as fast as possible.
int run_command(const RunOptions& options, const Folders& folders);
/// One trial from its specification.
int trial_command(const TrialOptions& options, const Folders& folders);
/// Lists the robots.
int robots_command(const RobotsOptions& options, const Folders& folders);
/// Finds the biped in a URDF and tells what was found; exit_no for what cannot walk.
int robots_check_command(const RobotsCheckOptions& options);
/// The paper's experiments beside what it publishes and beside the ceilings.
int paper_command(const PaperOptions& options);

}  // namespace stagger::server
