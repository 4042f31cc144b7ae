#include "server/recording/robot_files.h"

#include <fstream>
#include <iterator>
#include <map>
#include <system_error>

#include "sim/state_hash.h"

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

void mix(sim::StateHash& hash, const std::string& text) {
  hash.mix(static_cast<std::uint64_t>(text.size()));
  for (std::size_t i = 0; i < text.size(); i += 8) {
    std::uint64_t word = 0;
    for (std::size_t byte = i; byte < std::min(i + 8, text.size()); ++byte) {
      word = (word << 8) | static_cast<unsigned char>(text[byte]);
    }
    hash.mix(word);
  }
}

}  // namespace

std::string robot_files_hash(const fs::path& folder) {
  std::map<std::string, fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    if (it->is_regular_file(error)) files[it->path().lexically_relative(folder).string()] = *it;
  }
  if (error || files.empty()) return "";
  sim::StateHash hash;
  for (const auto& [name, file] : files) {
    std::ifstream in(file, std::ios::binary);
    if (!in) return "";
    mix(hash, name);
    mix(hash, std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()));
  }
  return sim::to_hex(hash.value());
}

}  // namespace stagger::server
