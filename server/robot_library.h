// The robots of one folder, each read once.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "sim/robot/robot.h"

namespace stagger::server {

/// Safe to use from several threads.
class RobotLibrary {
 public:
  explicit RobotLibrary(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Names of the robots, sorted.
  std::vector<std::string> names() const;
  /// nullptr when there is no robot of that name; throws std::runtime_error when its files are bad.
  std::shared_ptr<const sim::Robot> find(const std::string& name);
  /// "is \"x\"; robots here: a, b": what to tell someone who asked for a robot that is not there.
  std::string unknown(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const sim::Robot>> robots_;
};

}  // namespace stagger::server
