// URDF as it is uploaded: imported, and where that works looked at for legs.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "sim/robot/biped_finder.h"
#include "sim/robot/urdf_import.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stagger;
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("stagger-fuzz-" + std::to_string(getpid()));
  const std::string text = testing::text_of(data, size);
  try {
    sim::import_urdf(text, "fuzz.urdf");
    std::ofstream(file, std::ios::binary) << text;
    sim::find_biped(file);
  } catch (const std::runtime_error&) {
  }
  std::filesystem::remove(file);
  return 0;
}
