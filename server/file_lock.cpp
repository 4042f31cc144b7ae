#include "server/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <thread>

namespace stagger::server {
namespace {

constexpr std::chrono::milliseconds between_tries{5};

}  // namespace

std::optional<FileLock> FileLock::take(const std::filesystem::path& file,
                                       std::chrono::milliseconds patience) {
  const auto latest = std::chrono::steady_clock::now() + patience;
  const int descriptor = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    throw std::system_error(errno, std::generic_category(), "cannot write " + file.string());
  }
  FileLock lock(descriptor);
  // Tried again and again: a wait inside flock() has no end that could be set.
  while (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) {
      throw std::system_error(errno, std::generic_category(), "cannot lock " + file.string());
    }
    if (std::chrono::steady_clock::now() >= latest) return std::nullopt;
    std::this_thread::sleep_for(between_tries);
  }
  return lock;
}

bool FileLock::is_held(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  // Shared: two who look at the same time do not take each other for the holder.
  const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return held;
}

FileLock::~FileLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace stagger::server
