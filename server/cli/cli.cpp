#include "server/cli/cli.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <iostream>
#include <optional>
#include <sstream>

#include "server/cli/campaign.h"
#include "server/cli/commands.h"
#include "server/cli/settings.h"
#include "server/http/security.h"

namespace stagger::server {
namespace {

// CLI::Range lets NaN pass.
CLI::Validator between(double low, double high) {
  std::ostringstream range;
  range << "FLOAT in [" << low << " - " << high << "]";
  return CLI::Validator(
      [low, high](std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return "";
        std::ostringstream allowed;
        allowed << text << " is not a number from " << low << " to " << high;
        return allowed.str();
      },
      range.str());
}

void add_world(CLI::App& command, WorldOptions& world) {
  command.add_option("--robot", world.robot, "Robot, one of `stagger robots`");
  command.add_option("--plant", world.plant, "Full-body Bullet or the paper's pendulum")
      ->check(CLI::IsMember({"bullet", "lipm"}))
      ->capture_default_str();
  command.add_option("--seed", world.seed, "Seed of everything random")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      ->capture_default_str();
  command
      .add_option(
          "--state", world.state,
          "What control knows of the full body's state: an estimate from its sensors, or all")
      ->check(CLI::IsMember({"estimated", "perfect"}))
      ->capture_default_str();
  command
      .add_option("--control-delay-ms", world.control_delay_ms,
                  "From a measurement to the full body's torques made from it [ms]")
      ->check(CLI::Range(std::int64_t{0}, max_control_delay_ms))
      ->capture_default_str();
  command
      .add_option("--terrain", world.terrain,
                  "flat, slope:DEG, slope:DEG:UPHILL_DEG, uneven:METRES, or a trial's terrain as "
                  "JSON")
      ->capture_default_str();
  command
      .add_option("--parameter", world.parameters,
                  "name=value, may be given again: in place of the robot's own (see `parameters`)")
      ->allow_extra_args(false);
}

void add_walk(CLI::App& command, engine::WalkCommand& walk) {
  command.add_option("--vx", walk.vx, "Forward [m/s]")->check(between(-0.5, 0.5));
  command.add_option("--vy", walk.vy, "To the left [m/s]")->check(between(-0.3, 0.3));
  command.add_option("--wz", walk.wz, "Turn to the left [rad/s]")->check(between(-0.5, 0.5));
}

/// Takes only texts for which `why_not` has nothing to say; `form` is how they look.
CLI::Validator unless(std::optional<std::string> (*why_not)(const std::string&), const char* form) {
  return CLI::Validator(
      [why_not](std::string& text) -> std::string {
        const auto why = why_not(text);
        return why ? "\"" + text + "\": " + *why : "";
      },
      form);
}

CLI::App* add_serve(CLI::App& app, ServeOptions& serve) {
  CLI::App* command = app.add_subcommand("serve", "Serve the dashboard, the API and the stream");
  add_world(*command, serve.world);
  command->get_option("--robot")->capture_default_str();
  command->add_option("--host", serve.host, "Address to listen on")->capture_default_str();
  command->add_option("--port", serve.port, "Port to listen on; 0 for any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_flag("--stand", serve.stand, "Stand instead of stepping in place at once");
  command->add_option("--api-key-file", serve.api_key_file,
                      "File with the key that commands need (or STAGGER_API_KEY holds it); "
                      "without one, only this machine may be served");
  command->add_option("--read-only-key-file", serve.read_only_key_file,
                      "File with a key that may look only (or STAGGER_READ_ONLY_KEY holds it)");
  command
      ->add_option("--allow-host", serve.allow_hosts,
                   "Name by which the server is reached too, as behind a proxy; may be repeated")
      ->check(unless(why_no_host, "NAME[:PORT]"));
  command
      ->add_option("--allow-origin", serve.allow_origins,
                   "Origin of pages elsewhere that may use the API; may be repeated")
      ->check(unless(why_no_origin, "http[s]://NAME[:PORT]"));
  command->add_option("--stream-clients", serve.stream_clients, "Most stream clients at a time")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command
      ->add_option("--command-rate", serve.command_rate,
                   "Commands a second from one address; bursts of twice that [1/s]")
      ->check(between(1.0, 100000.0))
      ->capture_default_str();
  command->add_option("--data", serve.data,
                      "Folder of robots, recordings and presets (or STAGGER_DATA)");
  command->add_option("--quota-gb", serve.quota_gb, "Most that recordings may take [GB]")
      ->check(between(0.001, 1e6))
      ->capture_default_str();
  command->add_option("--log-level", serve.log_level, "What is told on standard error")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->capture_default_str();
  command
      ->add_option("--config", serve.config,
                   "File of settings (JSON); environment and command line go before it")
      ->configurable(false);
  command
      ->add_flag("--check-config", serve.check_config, "Print the resulting configuration and exit")
      ->configurable(false);
  return command;
}

CLI::App* add_limits(CLI::App& app, LimitsOptions& limits) {
  CLI::App* command = app.add_subcommand("limits", "Find how hard a push a robot takes");
  add_world(*command, limits.world);
  command->get_option("--robot")->required();
  command->get_option("--seed")->description("First seed");
  command->add_option("--seeds", limits.seeds, "How many seeds all have to pass")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  const auto list = [&](const char* name, std::string& text, const char* about) {
    command->add_option(name, text, about)->capture_default_str();
  };
  list("--directions", limits.directions, "0 forward, 90 to the left: a,b,... or FROM:TO:STEP");
  list("--phases", limits.phases, "Shares of single support that have passed, and standing");
  list("--durations", limits.durations, "Of the push [s]");
  list("--strategies", limits.strategies, "Of ankle, hip, step and time; or none");
  command->add_option("--leg", limits.leg, "Which leg stands at the phase")
      ->check(CLI::IsMember({"left", "right", "either"}))
      ->capture_default_str();
  command->add_option("--link", limits.link, "Link whose centre of mass is pushed (torso)");
  add_walk(*command, limits.walk);

  const auto number = [&](const char* name, double& value, double least, double most,
                          const char* about) {
    command->add_option(name, value, about)->check(between(least, most))->capture_default_str();
  };
  number("--from", limits.from, 0.001, 5.0, "Lowest delta-v tried [m/s]");
  number("--to", limits.to, 0.001, 5.0, "Highest delta-v tried [m/s]");
  number("--step", limits.step, 0.001, 5.0, "From one delta-v to the next [m/s]");
  command->add_option("--gate", limits.gate, "Go up to this delta-v; exit code 1 when one fails")
      ->check(between(0.001, 5.0))
      ->excludes("--to");
  number("--settle-s", limits.settle_s, 0.0, 60.0, "Before the push [s]");
  number("--observe-s", limits.observe_s, 0.0, 60.0, "After the push: still up then [s]");
  number("--recover-s", limits.recover_s, 0.0, 60.0,
         "After the push: back at the gait by then [s]");

  command->add_option("--threads", limits.threads, "0: one for each core")
      ->check(CLI::Range(0, 1024));
  command->add_flag("--json", limits.json, "Print one JSON object");
  command->add_option("--out", limits.out, "File to write the JSON to");
  command->add_option("--markdown", limits.markdown, "File to write a page of tables to");
  command->add_flag("--quiet", limits.quiet, "Do not tell how far it is");
  return command;
}

/// The command line as it was typed, without the way to the program.
std::string typed(int argc, char** argv) {
  std::string text = "stagger";
  for (int i = 1; i < argc; ++i) text += std::string(" ") + argv[i];
  return text;
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

  std::string data_folder;
  app.add_option("--data", data_folder,
                 "Folder of what users make: robots, recordings, presets (or STAGGER_DATA; "
                 "~/.local/share/stagger)");

  ServeOptions serve;
  CLI::App* serve_app = add_serve(app, serve);

  RunOptions run;
  CLI::App* run_app = app.add_subcommand("run", "Walk without a server, as fast as possible");
  add_world(*run_app, run.world);
  run_app->get_option("--robot")->required();
  run_app->add_option("--seconds", run.seconds, "Simulated time [s]")
      ->check(between(0.001, 86400.0))
      ->capture_default_str();
  add_walk(*run_app, run.walk);
  run_app->add_flag("--json", run.json, "Print one JSON object");

  TrialOptions trial;
  CLI::App* trial_app = app.add_subcommand("trial", "Run one push trial");
  trial_app->add_option("spec", trial.spec, "Trial specification (JSON), or - for standard input")
      ->required();

  LimitsOptions limits;
  CLI::App* limits_app = add_limits(app, limits);
  limits.command = typed(argc, argv);

  ParametersOptions parameters;
  CLI::App* parameters_app =
      app.add_subcommand("parameters", "List the parameters of a robot: values, ranges, meanings");
  add_world(*parameters_app, parameters.world);
  parameters_app->get_option("--robot")->capture_default_str();
  parameters_app->add_flag("--json", parameters.json, "Print one JSON object");
  ReplayOptions replay;
  CLI::App* replay_app =
      app.add_subcommand("replay", "Run a recording again and compare it tick by tick");
  replay_app->add_option("file", replay.file, "Recording (MCAP)")->required();
  replay_app->add_flag("--json", replay.json, "Print one JSON object");
  CampaignOptions campaign;
  CLI::App* campaign_app = add_campaign(app, campaign);

  RobotsOptions robots;
  CLI::App* robots_app = app.add_subcommand("robots", "List the robots");
  robots_app->add_flag("--json", robots.json, "Print one JSON object");

  RobotsCheckOptions check;
  CLI::App* check_app =
      robots_app->add_subcommand("check", "Look into any URDF: legs, soles, pose, quirks");
  check_app->add_option("urdf", check.urdf, "URDF of a biped")->required();
  check_app->add_option("--write", check.write, "Folder to write a robot's description to");
  check_app->add_flag("--json", check.json, "Print one JSON object");
  check_app->add_flag("--load", check.load,
                      "Check the robot.json beside the URDF too; it may say what is not found");
  check_app->add_flag("--untrusted", check.untrusted,
                      "A stranger's files: end when they cost much time or memory");

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
    if (serve_app->parsed()) {
      if (!apply_settings(*serve_app, serve.config)) return exit_usage;
      serve.settings = settings_json(*serve_app);
    }
    const Folders folders =
        find_folders(robots_folder, web_folder, serve.data.empty() ? data_folder : serve.data);
    if (serve_app->parsed()) return serve_command(serve, folders);
    if (run_app->parsed()) return run_command(run, folders);
    if (trial_app->parsed()) return trial_command(trial, folders);
    if (parameters_app->parsed()) return parameters_command(parameters, folders);
    if (replay_app->parsed()) return replay_command(replay, folders);
    if (limits_app->parsed()) return limits_command(limits, folders);
    if (campaign_app->parsed()) return campaign_command(campaign, folders);
    return robots_command(robots, folders);
  } catch (const std::exception& error) {
    std::cerr << "stagger: " << error.what() << '\n';
    return exit_usage;
  }
}

}  // namespace stagger::server
