// Recordings: files that may have been cut off, or never were any. Read, repaired, read again, and
// a part of them cut out; what was cut out is a whole recording, whatever it was cut from.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "server/recording/mcap_cut.h"
#include "server/recording/mcap_reader.h"
#include "server/recording/recording_reader.h"
#include "tests/fuzz/fuzz.h"

namespace stagger::server {
namespace {

void read_all(const std::filesystem::path& file) {
  try {
    RecordingReader reader(file);
    while (const auto item = reader.next()) {
      if (const auto* world = std::get_if<RecordedWorld>(&*item)) world_of(*world);
      if (const auto* text = std::get_if<RecordedText>(&*item)) entry_of(*text);
    }
  } catch (const std::runtime_error&) {
  }
}

/// False when there was nothing to cut from.
bool cut(const std::filesystem::path& file, const Selection& selection,
         const std::filesystem::path& out) {
  try {
    sim::JsonErrors errors;
    McapCut part(file, selection, errors);
    std::string bytes;
    for (bool more = errors.empty(); more;) more = part.next(bytes);
    std::ofstream(out, std::ios::binary) << bytes;
    return errors.empty();
  } catch (const std::runtime_error&) {
    return false;
  }
}

}  // namespace
}  // namespace stagger::server

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stagger::server;
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("stagger-fuzz-" + std::to_string(getpid()));
  std::ofstream(file, std::ios::binary) << stagger::testing::text_of(data, size);
  read_all(file);
  try {
    repair_mcap(file);
    read_all(file);
  } catch (const std::runtime_error&) {
  }
  const std::filesystem::path part = file.string() + "-part";
  Selection selection;
  if (cut(file, selection, part)) {
    for (RecordingReader reader(part); reader.next();) {
    }  // must not throw
    selection.every = 3;
    selection.from_s = 0.002;
    selection.to_s = 0.02;
    if (cut(part, selection, part.string() + "-again")) read_all(part.string() + "-again");
  }
  std::filesystem::remove(part.string() + "-again");
  std::filesystem::remove(part);
  std::filesystem::remove(file);
  return 0;
}
