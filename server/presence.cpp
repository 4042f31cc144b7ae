#include "server/presence.h"

#include <cstdio>
#include <random>
#include <stdexcept>

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

/// For what takes a moment; whoever is longer at it is stopped, and not dead.
constexpr std::chrono::seconds entry_patience{10};

std::string new_name() {
  std::random_device random;
  char text[17];
  std::snprintf(text, sizeof text, "%08x%08x", random(), random());
  return text;
}

}  // namespace

Presence::Presence(const fs::path& data) : folder_(data / "servers"), name_(new_name()) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) {
    throw std::runtime_error("the data folder " + data.string() +
                             " cannot be made: " + error.message());
  }
  // One comes at a time: a file that is not locked yet would be taken for that of a dead one.
  const auto door = FileLock::take(data / "servers.lock", entry_patience);
  if (!door) {
    throw std::runtime_error("another process holds " + (data / "servers.lock").string());
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    if (!FileLock::is_held(entry.path())) fs::remove(entry.path(), error);
  }
  lock_ = FileLock::take(folder_ / name_);
}

Presence::~Presence() {
  std::error_code ignored;
  fs::remove(folder_ / name_, ignored);
}

bool Presence::is_there(const std::string& name) const {
  return !name.empty() && FileLock::is_held(folder_ / name);
}

}  // namespace stagger::server
