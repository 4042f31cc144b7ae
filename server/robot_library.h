// The robots that there are: those of one folder, and those that were uploaded, each read once.
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
  /// `uploads` need not exist; empty: there are none. A name of `folder` comes first.
  explicit RobotLibrary(std::filesystem::path folder, std::filesystem::path uploads = {})
      : folder_(std::move(folder)), uploads_(std::move(uploads)) {}

  /// Names of the robots, sorted.
  std::vector<std::string> names() const;
  /// nullptr when there is no robot of that name; throws std::runtime_error when its files are bad.
  std::shared_ptr<const sim::Robot> find(const std::string& name);
  /// Was the robot of that name uploaded?
  bool is_uploaded(const std::string& name) const;
  std::size_t upload_count() const { return sim::list_robots(uploads_).size(); }
  /// Makes the folder a robot of that name, which must be free. Throws std::runtime_error.
  void add_upload(const std::filesystem::path& folder, const std::string& name);
  /// Deletes an uploaded robot; whoever holds it keeps it. Throws std::runtime_error.
  void remove_upload(const std::string& name);
  /// "is \"x\"; robots here: a, b": what to tell someone who asked for a robot that is not there.
  std::string unknown(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path uploads_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const sim::Robot>> robots_;
};

}  // namespace stagger::server
