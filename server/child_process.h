// A program that is run and waited for, within bounds.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace stagger::server {

struct ChildResult {
  enum class End {
    exited,
    killed,    ///< by a signal of its own making, or a limit of the system
    too_long,  ///< out of time, or out of `output`
    stopped    ///< we were told to stop
  };
  End end = End::exited;
  int code = 0;  ///< exit code, or the signal
  std::string out;
  std::string err;
};

struct ChildOptions {
  std::filesystem::path program;
  std::vector<std::string> arguments;  ///< without the program's own name
  std::filesystem::path folder;        ///< to work in
  std::chrono::milliseconds patience{30000};
  std::size_t output = 4U << 20U;  ///< most bytes of either stream
};

/// Runs the program without input and with no file of ours open, and waits until it has ended; it
/// is killed when its time is up and soon after `stop` becomes true. Throws std::runtime_error when
/// it cannot be started. Any thread.
ChildResult run_child(const ChildOptions& options, const std::atomic<bool>& stop);

}  // namespace stagger::server
