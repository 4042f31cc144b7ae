// Runs a recording again, from its worlds' configurations and commands, and compares every tick.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/robot/robot.h"

namespace stagger::server {

/// Where a replay and its recording part.
struct ReplayDifference {
  std::uint64_t tick = 0;  ///< first one, of those that were compared, whose state hash differs
  std::uint64_t recorded_hash = 0;
  std::uint64_t replayed_hash = 0;
  /// The number of a frame that differs most, in the first frame that differs: that of this tick or
  /// of a later one (a frame is told before its tick is run). None when no frame does.
  struct Largest {
    std::uint64_t tick = 0;
    std::string number;  ///< "com.x"
    std::string unit;
    double recorded = 0.0;
    double replayed = 0.0;
  };
  std::optional<Largest> largest;
};

struct WorldReplay {
  std::size_t number = 0;  ///< in the recording
  std::string session_id;
  std::string robot;
  std::string version;      ///< that recorded it
  std::uint64_t ticks = 0;  ///< compared; with none of them nothing is known
  std::uint64_t commands = 0;
  bool fell = false;
  std::optional<ReplayDifference> difference;
  std::vector<std::string> warnings;
};

using RobotFinder = std::function<std::shared_ptr<const sim::Robot>(const std::string& name)>;

/// A replay stops at the end of the world in which a difference was found. Throws
/// std::runtime_error when the file is no recording, cannot be replayed, or holds no tick at all.
std::vector<WorldReplay> replay(const std::filesystem::path& file, const RobotFinder& find_robot);

}  // namespace stagger::server
