#include <chrono>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <sstream>

#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/cli/interrupt.h"
#include "server/cli/list.h"
#include "server/cli/output_file.h"
#include "server/cli/progress_line.h"
#include "server/json/gait_json.h"
#include "server/json/limits_json.h"
#include "server/json/robot_json.h"
#include "server/report/limits_table.h"
#include "server/robot_library.h"

namespace stagger::server {
namespace {

using sim::Range;

engine::Strategies read_strategies_option(const std::string& text) {
  if (text == "none") return {.ankle = false, .hip = false, .step = false, .time = false};
  const nlohmann::json body{{"strategies", split(text, ',')}};
  sim::JsonErrors errors;
  std::optional<engine::Strategies> chosen;
  sim::read_json(body, errors, [&](sim::JsonReader& reader) {
    chosen = read_strategy_names(reader, "strategies");
  });
  if (errors.empty()) return *chosen;
  throw std::invalid_argument("--strategies: " + text + " " + errors.list().front().text);
}

std::vector<std::optional<double>> read_phases(const std::string& text) {
  std::vector<std::optional<double>> phases;
  std::string numbers;
  for (const std::string& part : split(text, ',')) {
    if (part == "standing") {
      phases.emplace_back();
    } else {
      numbers += (numbers.empty() ? "" : ",") + part;
    }
  }
  if (phases.size() > 1) throw std::invalid_argument("--phases: names standing twice");
  if (numbers.empty()) return phases;
  const auto range = Range::from_to_below(0.0, 1.0, "of single support, or standing");
  for (const double phase : read_number_list("--phases", numbers, range))
    phases.emplace_back(phase);
  return phases;
}

std::vector<double> read_ladder(const LimitsOptions& options) {
  const double top = options.gate.value_or(options.to);
  const char* const name = options.gate ? "--gate" : "--to";
  if (top < options.from) {
    std::ostringstream text;
    text << name << ": " << top << " is not a number from " << options.from << " (--from) to 5 m/s";
    throw std::invalid_argument(text.str());
  }
  constexpr double most_rungs = 1000.0;
  if ((top - options.from) / options.step >= most_rungs) {
    std::ostringstream text;
    text << "--step: " << options.step << " makes more than 1000 rungs from " << options.from
         << " to " << top << " m/s; allowed: more than " << (top - options.from) / most_rungs;
    throw std::invalid_argument(text.str());
  }
  std::vector<double> rungs = sim::ladder(options.from, top, options.step);
  if (options.gate && rungs.back() < top - 1e-9) rungs.push_back(top);
  return rungs;
}

std::vector<std::uint64_t> read_seeds(const LimitsOptions& options) {
  // Beyond that JSON's numbers are not exact.
  constexpr std::uint64_t greatest = std::uint64_t{1} << 53;
  const auto count = static_cast<std::uint64_t>(options.seeds);
  if (options.world.seed > greatest - (count - 1)) {
    throw std::invalid_argument("--seed: " + std::to_string(options.world.seed) +
                                " is not a number from 0 to " +
                                std::to_string(greatest - (count - 1)) + " (2^53 less --seeds)");
  }
  std::vector<std::uint64_t> seeds(count);
  std::iota(seeds.begin(), seeds.end(), options.world.seed);
  return seeds;
}

/// Nobody looks any more once the observation is over.
void check_times(const LimitsOptions& options) {
  if (options.recover_s <= options.observe_s) return;
  std::ostringstream text;
  text << "--recover-s: " << options.recover_s << " is not a number from 0 to " << options.observe_s
       << " s (--observe-s)";
  throw std::invalid_argument(text.str());
}

sim::LimitsSpec spec_of(const LimitsOptions& options, const sim::SimulationConfig& world) {
  check_times(options);
  sim::LimitsSpec spec;
  const sim::Robot& robot = *world.robot;
  spec.trial.robot = options.world.robot;
  spec.trial.plant = world.plant;
  spec.trial.senses = world.senses;
  spec.trial.terrain = world.terrain;
  spec.trial.parameters = world.parameters;
  spec.trial.walk = options.walk;
  spec.trial.strategies = read_strategies_option(options.strategies);
  spec.trial.settle_s = options.settle_s;
  spec.trial.observe_s = options.observe_s;
  spec.recover_within_s = options.recover_s;
  sim::PushSpec push;
  push.link = options.link.empty() ? robot.description.torso : options.link;
  if (const auto wrong = check_link(push.link, robot)) {
    throw std::invalid_argument("--link " + *wrong);
  }
  spec.trial.push = push;
  if (options.leg != "left") {
    spec.leg = options.leg == "right" ? std::optional(sim::Side::right) : std::nullopt;
  }
  spec.rungs = read_ladder(options);
  spec.seeds = read_seeds(options);
  const auto directions = read_number_list("--directions", options.directions,
                                           Range::between(-360.0, 360.0, "degrees"));
  const auto durations =
      read_number_list("--durations", options.durations, Range::between(0.001, 2.0, "s"));
  for (const double duration : durations) {
    for (const std::optional<double>& phase : read_phases(options.phases)) {
      for (const double direction : directions) spec.cells.push_back({direction, phase, duration});
    }
  }
  return spec;
}

std::string today() {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::ostringstream text;
  text << std::put_time(&parts, "%Y-%m-%d");
  return text.str();
}

}  // namespace

int limits_command(const LimitsOptions& options, const Folders& folders) {
  RobotLibrary library(folders.robots, folders.uploaded_robots());
  const sim::SimulationConfig world = world_of(options.world, library);
  if (world.robot == nullptr) return exit_usage;
  const auto& robot = world.robot;
  const sim::LimitsSpec spec = spec_of(options, world);
  const OutputFile out("--out", options.out);
  const OutputFile markdown("--markdown", options.markdown);

  listen_for_interrupts();
  std::vector<sim::Limit> limits;
  sim::LimitsProgress last;
  {
    ProgressLine line(options.quiet);
    try {
      sim::LimitsRun run;
      if (options.threads > 0) run.threads = options.threads;
      run.watch = [&](const sim::LimitsProgress& progress) {
        last = progress;
        line.show([&](double elapsed_s) { return progress_text(progress, elapsed_s); });
        return !interrupted();
      };
      limits = sim::find_limits(spec, robot, run);
    } catch (const sim::LimitsStopped&) {
      line.clear();
      std::cerr << "stagger: stopped at " << last.rung << " m/s after " << last.trials
                << " trials; no limit is known yet\n";
      return exit_interrupted;
    }
  }

  const std::string json = limits_json(spec, limits, *robot).dump(2) + '\n';
  out.write(json);
  markdown.write(limits_markdown(spec, limits, *robot, options.command, today()));
  std::cout << (options.json ? json : limits_columns(spec, limits, *robot));
  const bool passed = std::all_of(limits.begin(), limits.end(),
                                  [](const sim::Limit& limit) { return !limit.fail_dv; });
  return options.gate && !passed ? exit_no : exit_ok;
}

}  // namespace stagger::server
