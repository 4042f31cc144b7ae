#include "server/recording/mcap_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace stagger::server {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

McapFile::McapFile(const std::filesystem::path& path, Open how)
    : file_(::open(path.c_str(), O_WRONLY | O_CLOEXEC | (how == Open::make ? O_CREAT | O_EXCL : 0),
                   0644)) {
  if (file_ < 0) fail("cannot write " + path.string());
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const int error = errno;
  ::close(file_);
  errno = error;
  fail("another process writes " + path.string());
}

McapFile::~McapFile() {
  if (file_ >= 0) ::close(file_);
}

void McapFile::cut(std::uint64_t size) {
  const auto end = static_cast<off_t>(size);
  if (::ftruncate(file_, end) != 0 || ::lseek(file_, end, SEEK_SET) < 0) {
    fail("cannot write the recording");
  }
  size_ = size;
}

void McapFile::write(std::string_view bytes) {
  const std::uint64_t before = size_;
  while (!bytes.empty()) {
    const ssize_t n = ::write(file_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const int error = errno;
      cut(before);
      errno = error;
      fail("cannot write the recording");
    }
    size_ += static_cast<std::uint64_t>(n);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void McapFile::finish() {
  ::fdatasync(file_);
  ::close(std::exchange(file_, -1));
}

}  // namespace stagger::server
