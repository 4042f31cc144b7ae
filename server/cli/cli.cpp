#include "server/cli/cli.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <iostream>
#include <sstream>

#include "server/cli/commands.h"

namespace stagger::server {
namespace {

// CLI::Range lets NaN pass.
CLI::Validator between(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return "";
        std::ostringstream allowed;
        allowed << text << " is not a number from " << low << " to " << high;
        return allowed.str();
      },
      "FLOAT");
}

void add_world(CLI::App& command, std::string& robot, std::string& plant, std::uint64_t& seed) {
  command.add_option("--robot", robot, "Robot, one of `stagger robots`");
  command.add_option("--plant", plant, "Full-body Bullet or the paper's pendulum")
      ->check(CLI::IsMember({"bullet", "lipm"}))
      ->capture_default_str();
  command.add_option("--seed", seed, "Seed of everything random")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      ->capture_default_str();
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app{"Push-testing server for biped robots", "stagger"};
  app.set_version_flag("--version", STAGGER_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  std::string robots_folder;
  std::string web_folder;
  app.add_option("--robots-dir", robots_folder, "Folder of robots (or STAGGER_ROBOTS)");
  app.add_option("--web-dir", web_folder, "Folder of the built dashboard (or STAGGER_WEB)");

  ServeOptions serve;
  CLI::App* serve_app = app.add_subcommand("serve", "Serve the dashboard, the API and the stream");
  add_world(*serve_app, serve.robot, serve.plant, serve.seed);
  serve_app->get_option("--robot")->capture_default_str();
  serve_app->add_option("--host", serve.host, "Address to listen on")->capture_default_str();
  serve_app->add_option("--port", serve.port, "Port to listen on; 0 for any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  serve_app->add_flag("--stand", serve.stand, "Stand instead of stepping in place at once");
  serve_app->add_flag("--allow-remote", serve.allow_remote,
                      "Allow an address that is not loopback; nobody is asked for a key");
  serve_app->add_option("--stream-clients", serve.stream_clients, "Most stream clients at a time")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  serve_app->add_option("--log-level", serve.log_level)
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->capture_default_str();

  RunOptions run;
  CLI::App* run_app = app.add_subcommand("run", "Walk without a server, as fast as possible");
  add_world(*run_app, run.robot, run.plant, run.seed);
  run_app->get_option("--robot")->required();
  run_app->add_option("--seconds", run.seconds, "Simulated time [s]")
      ->check(between(0.001, 86400.0))
      ->capture_default_str();
  run_app->add_option("--vx", run.walk.vx, "Forward [m/s]")->check(between(-0.5, 0.5));
  run_app->add_option("--vy", run.walk.vy, "To the left [m/s]")->check(between(-0.3, 0.3));
  run_app->add_option("--wz", run.walk.wz, "Turn to the left [rad/s]")->check(between(-0.5, 0.5));
  run_app->add_flag("--json", run.json, "Print one JSON object");

  TrialOptions trial;
  CLI::App* trial_app = app.add_subcommand("trial", "Run one push trial");
  trial_app->add_option("spec", trial.spec, "Trial specification (JSON), or - for standard input")
      ->required();

  RobotsOptions robots;
  CLI::App* robots_app = app.add_subcommand("robots", "List the robots");
  robots_app->add_flag("--json", robots.json, "Print one JSON object");

  RobotsCheckOptions check;
  CLI::App* check_app =
      robots_app->add_subcommand("check", "Look into any URDF: legs, soles, pose, quirks");
  check_app->add_option("urdf", check.urdf, "URDF of a biped")->required();
  check_app->add_option("--write", check.write, "Folder to write a robot's description to");
  check_app->add_flag("--json", check.json, "Print one JSON object");

  PaperOptions paper;
  CLI::App* paper_app =
      app.add_subcommand("paper", "Repeat the paper's experiments, beside its numbers");
  paper_app->add_option("section", paper.section, "One of them alone")
      ->check(CLI::IsMember({"plan", "lqg", "scenario1", "scenario2", "robustness"}));
  paper_app->add_flag("--json", paper.json, "Print one JSON object");
  paper_app->add_option("--out", paper.out, "Folder to write report.html to");
  paper_app->add_option("--seeds", paper.seeds, "Seeds of everything that is tried under noise")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  paper_app->add_option("--t-ss", paper.t_ss, "scenario2: single support [s]")
      ->check(between(0.2, 3.0));
  paper_app->add_option("--t-ds", paper.t_ds, "scenario2: double support [s]")
      ->check(between(0.0, 1.0));
  paper_app->add_option("--t-left", paper.t_left, "scenario2: single support left at the push [s]")
      ->check(between(0.0, 3.0));
  paper_app
      ->add_option("--direction-deg", paper.direction_deg,
                   "scenario2: of the push; 0 forward, 90 to the left")
      ->check(between(-360.0, 360.0));

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_ok : exit_usage;
  }

  try {
    if (paper_app->parsed()) return paper_command(paper);
    if (check_app->parsed()) return robots_check_command(check);
    const Folders folders = find_folders(robots_folder, web_folder);
    if (serve_app->parsed()) return serve_command(serve, folders);
    if (run_app->parsed()) return run_command(run, folders);
    if (trial_app->parsed()) return trial_command(trial, folders);
    return robots_command(robots, folders);
  } catch (const std::exception& error) {
    std::cerr << "stagger: " << error.what() << '\n';
    return exit_usage;
  }
}

}  // namespace stagger::server
