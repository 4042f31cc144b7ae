// Robots from strangers: looked into by a process of their own, kept in the data folder.
#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "server/json/json.h"
#include "server/robot_library.h"

namespace stagger::server {

struct RobotUpload {
  std::string name;
  std::string urdf;         ///< its text
  std::string description;  ///< text of a robot.json; empty: to be found
  std::vector<std::pair<std::string, std::string>> meshes;  ///< path as in the URDF -> content
};

/// A robot that is not taken, for a reason that lies in it.
class RobotRefused : public std::runtime_error {
 public:
  RobotRefused(std::string which, const std::string& why)
      : std::runtime_error(why), field(std::move(which)) {}
  std::string field;  ///< "urdf", "description", "mesh" or "name"
};

/// Safe to use from several threads; looks into one robot at a time. Throws RobotRefused, and
/// CommandError: conflict for a name that is taken, busy when others wait already.
class RobotUploads {
 public:
  static constexpr std::size_t most_robots = 50;
  static constexpr std::size_t most_meshes = 200;

  /// `data`: folder that is made when it is needed; `program`: this program's executable.
  RobotUploads(RobotLibrary& library, std::filesystem::path data, std::filesystem::path program);

  /// What `stagger robots check --json` tells of it. Stores nothing; the name need not be given.
  Json check(const RobotUpload& upload);
  /// The same, and it becomes a robot.
  Json store(const RobotUpload& upload);
  bool is_uploaded(const std::string& name) const { return library_.is_uploaded(name); }
  /// Deletes an uploaded robot; not_found for others, conflict for one that was not uploaded.
  void remove(const std::string& name);
  /// Whoever waits for a check gets an error now.
  void stop() { stopping_ = true; }

 private:
  class Workplace;
  Json look_into(const RobotUpload& upload, const std::filesystem::path& folder);

  RobotLibrary& library_;
  const std::filesystem::path data_;
  const std::filesystem::path program_;
  std::timed_mutex mutex_;
  std::atomic<bool> stopping_{false};
};

}  // namespace stagger::server
