#include <algorithm>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <sstream>

#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/cli/output_file.h"
#include "server/json/paper_json.h"
#include "server/report/paper_report.h"
#include "server/report/paper_table.h"

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

constexpr int most_standing_seeds = 5;
/// A push of 10 ms must be over well before the foot lands [s].
constexpr double least_t_left = 0.02;

bool asks_for_timing(const PaperOptions& options) {
  return options.t_ss || options.t_ds || options.t_left || options.direction_deg;
}

/// What the options rule out together; empty: nothing.
std::string conflict(const PaperOptions& options) {
  if (!asks_for_timing(options)) return "";
  if (options.section != "scenario2") {
    return "--t-ss, --t-ds, --t-left and --direction-deg belong to `stagger paper scenario2`";
  }
  for (const auto& [name, value] : {std::pair{"--t-ss", options.t_ss},
                                    {"--t-ds", options.t_ds},
                                    {"--t-left", options.t_left}}) {
    if (!value) {
      return std::string(name) + " is missing: a timing takes --t-ss, --t-ds and --t-left together";
    }
  }
  if (*options.t_left <= least_t_left || *options.t_left > *options.t_ss) {
    std::ostringstream text;
    text << "--t-left: " << *options.t_left << " is not a number above " << least_t_left
         << " and up to " << *options.t_ss << " (--t-ss)";
    return text.str();
  }
  return "";
}

sim::PaperRequest request_of(const PaperOptions& options) {
  const auto wanted = [&](const char* section) {
    return options.section.empty() || options.section == section;
  };
  sim::PaperRequest request;
  request.plan = wanted("plan");
  request.tracking = wanted("lqg");
  request.standing = wanted("scenario1");
  request.stepping = wanted("scenario2");
  request.robustness = wanted("robustness");
  request.seeds = options.seeds;
  request.standing_seeds = std::min(options.seeds, most_standing_seeds);
  if (options.t_ss) {
    request.timing = sim::PushTiming{*options.t_ss, *options.t_ds, *options.t_left};
    request.direction = options.direction_deg.value_or(0.0) * std::numbers::pi / 180.0;
  }
  return request;
}

/// The command that gives these results, for the report; where they go does not matter.
std::string command_of(const PaperOptions& options) {
  std::ostringstream text;
  text << "stagger paper";
  if (!options.section.empty()) text << ' ' << options.section;
  if (options.t_ss) {
    text << " --t-ss " << *options.t_ss << " --t-ds " << *options.t_ds << " --t-left "
         << *options.t_left;
  }
  if (options.direction_deg) text << " --direction-deg " << *options.direction_deg;
  text << " --seeds " << options.seeds;
  return text.str();
}

}  // namespace

int paper_command(const PaperOptions& options) {
  if (const std::string text = conflict(options); !text.empty()) {
    std::cerr << "stagger: " << text << '\n';
    return exit_usage;
  }
  std::string file;
  if (!options.out.empty()) {
    std::error_code error;
    fs::create_directories(options.out, error);
    file = (fs::path(options.out) / "report.html").string();
  }
  const OutputFile report("--out", file);

  const sim::PaperResults results = sim::run_paper(request_of(options));
  if (!file.empty()) report.write(paper_report(results, command_of(options)));
  if (options.json) {
    std::cout << paper_json(results).dump(2) << '\n';
  } else {
    std::cout << to_columns(paper_table(results));
  }
  // Beside JSON, not within it.
  if (!file.empty()) (options.json ? std::cerr : std::cout) << "report: " << file << '\n';
  return exit_ok;
}

}  // namespace stagger::server
