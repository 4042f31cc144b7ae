// Several servers may share a data folder: who of them is there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "server/file_lock.h"

namespace stagger::server {

/// A server's presence in a data folder, under a name that no other has had or will have. What a
/// server is at carries its name there; once it is gone, killed or not, others may put that in
/// order. Told by a lock, not by a process id, which another process may have next.
class Presence {
 public:
  /// Makes the folder. Throws std::runtime_error when it cannot be used.
  explicit Presence(const std::filesystem::path& data);
  ~Presence();
  Presence(const Presence&) = delete;
  Presence& operator=(const Presence&) = delete;

  const std::string& name() const { return name_; }
  /// Whether the server of that name lives, this one included.
  bool is_there(const std::string& name) const;
  bool is_another(const std::string& name) const { return name != name_ && is_there(name); }

 private:
  std::filesystem::path folder_;
  std::string name_;
  std::optional<FileLock> lock_;
};

}  // namespace stagger::server
