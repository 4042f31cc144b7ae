#include "server/recording/replay.h"

#include <cmath>
#include <iostream>

#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/json/json.h"
#include "sim/state_hash.h"

namespace stagger::server {
namespace {

Json difference_json(const ReplayDifference& difference) {
  Json json{{"tick", difference.tick},
            {"recorded_hash", sim::to_hex(difference.recorded_hash)},
            {"replayed_hash", sim::to_hex(difference.replayed_hash)},
            {"largest", nullptr}};
  if (const auto& largest = difference.largest) {
    json["largest"] = {{"tick", largest->tick},
                       {"number", largest->number},
                       {"unit", largest->unit},
                       {"recorded", largest->recorded},
                       {"replayed", largest->replayed},
                       {"difference", std::abs(largest->recorded - largest->replayed)}};
  }
  return json;
}

Json world_report(const WorldReplay& world) {
  return {{"world", world.number},
          {"session_id", world.session_id},
          {"robot", world.robot},
          {"version", world.version},
          {"ticks", world.ticks},
          {"commands", world.commands},
          {"fell", world.fell},
          {"equal", world.ticks > 0 ? Json(!world.difference) : Json(nullptr)},
          {"difference", world.difference ? difference_json(*world.difference) : Json(nullptr)},
          {"warnings", world.warnings}};
}

void print(const WorldReplay& world) {
  std::cout << "world " << world.number << ", robot " << world.robot << ": " << world.ticks
            << " ticks and " << world.commands << " commands, ";
  if (world.ticks == 0) {
    std::cout << "nothing to compare\n";
    return;
  }
  if (!world.difference) {
    std::cout << "equal to the last bit\n";
    return;
  }
  std::cout << "differs from tick " << world.difference->tick << " on\n";
  if (const auto& largest = world.difference->largest) {
    std::cout << "  most at tick " << largest->tick << " in " << largest->number << ": recorded "
              << largest->recorded << ' ' << largest->unit << ", replayed " << largest->replayed
              << ' ' << largest->unit << ", " << std::abs(largest->recorded - largest->replayed)
              << ' ' << largest->unit << " apart\n";
  }
}

}  // namespace

int replay_command(const ReplayOptions& options, const Folders& folders) {
  RobotLibrary robots(folders.robots);
  const auto worlds =
      replay(options.file, [&robots](const auto& name) { return robots.find(name); });
  bool equal = true;
  Json reports = Json::array();
  for (const WorldReplay& world : worlds) {
    equal = equal && !world.difference;
    reports.push_back(world_report(world));
    if (options.json) continue;
    print(world);
    for (const std::string& warning : world.warnings) std::cerr << "stagger: " << warning << '\n';
  }
  if (options.json) {
    std::cout << Json{{"file", options.file},
                      {"equal", equal},
                      {"worlds", std::move(reports)},
                      {"version", STAGGER_VERSION}}
                     .dump(2)
              << '\n';
  }
  return equal ? exit_ok : exit_no;
}

}  // namespace stagger::server
