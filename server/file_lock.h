// A lock between processes: a file that one of them holds, and that is let go of with its process
// however that ends.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

namespace stagger::server {

class FileLock {
 public:
  /// Makes the file where it is missing; nothing when others hold it for longer than that. Throws
  /// std::system_error when there can be no such file.
  static std::optional<FileLock> take(const std::filesystem::path& file,
                                      std::chrono::milliseconds patience = {});
  /// Whether anybody holds it, this process included. A file that is not there is held by nobody.
  static bool is_held(const std::filesystem::path& file);

  FileLock(FileLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  FileLock& operator=(FileLock&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  ~FileLock();

 private:
  explicit FileLock(int file) : file_(file) {}

  int file_;
};

}  // namespace stagger::server
