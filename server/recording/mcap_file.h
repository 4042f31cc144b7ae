// An MCAP file that is written: locked for as long, so that whoever repairs files leaves it alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace stagger::server {

/// Throws std::system_error when the disk does not take it, or another process writes the file.
class McapFile {
 public:
  enum class Open : std::uint8_t { make, change };

  /// Makes the file, which must not exist, or opens one to go on with.
  McapFile(const std::filesystem::path& path, Open how);
  McapFile(const McapFile&) = delete;
  McapFile& operator=(const McapFile&) = delete;
  ~McapFile();

  /// Cuts off what comes after so many bytes, and goes on there.
  void cut(std::uint64_t size);
  /// All of it or nothing: what did not go in whole is taken back.
  void write(std::string_view bytes);
  /// Nothing can be written after it; a loss of power does no harm from here on.
  void finish();

 private:
  int file_;
  std::uint64_t size_ = 0;
};

}  // namespace stagger::server
