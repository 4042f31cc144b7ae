// A made-up biped in a folder of its own, found and written there.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "biped_urdf.h"
#include "sim/robot/biped_finder.h"
#include "sim/robot/description_writer.h"

namespace stagger::sim {

/// A folder that goes away with this object; tests run side by side.
class TestFolder {
 public:
  TestFolder() {
    static int count = 0;
    path_ = std::filesystem::path(::testing::TempDir()) /
            ("stagger_" + std::to_string(getpid()) + "_" + std::to_string(++count));
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;  // a destructor may not throw
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline BipedFinding find_text(const std::string& urdf) {
  const TestFolder folder;
  return find_biped(folder.write("made_up.urdf", urdf));
}

inline BipedFinding find_plan(const BipedPlan& plan) { return find_text(biped_urdf(plan)); }

/// The robot as it is after the way through its written description.
inline std::shared_ptr<const Robot> written_robot(const std::filesystem::path& urdf) {
  const TestFolder folder;
  write_robot(find_biped(urdf), folder.path() / "robot");
  return load_robot(folder.path() / "robot");
}

inline std::shared_ptr<const Robot> written_robot(const BipedPlan& plan) {
  const TestFolder folder;
  return written_robot(folder.write("made_up.urdf", biped_urdf(plan)));
}

}  // namespace stagger::sim
