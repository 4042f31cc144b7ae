// The slip that whoever sends a command holds until the simulation thread has answered it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace stagger::server {

/// Why a command was not carried out.
class CommandError : public std::runtime_error {
 public:
  enum class Kind {
    conflict,   ///< not possible in the present state
    not_found,  ///< speaks of something that is not there
    invalid,    ///< asks for something that the robot does not have
    busy,       ///< too many commands wait
    timeout,    ///< the simulation thread did not answer in time
    failed,     ///< the simulation broke down over it
    stopping    ///< the server is about to end
  };
  CommandError(Kind kind, const std::string& detail) : std::runtime_error(detail), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// One answer from one thread to another. No exception object goes with it, nor a copy of one (and
/// so no std::promise): copies share their message, and whichever thread frees it does so inside
/// the C++ library, where the thread sanitizer cannot follow.
template <typename T>
class Ticket {
 public:
  /// The simulation thread begins with the command; false when the sender has given up.
  bool claim() {
    const std::lock_guard lock(mutex_);
    claimed_ = !withdrawn_;
    return claimed_;
  }

  void answer(T value) {
    {
      const std::lock_guard lock(mutex_);
      value_ = std::move(value);
    }
    answered_.notify_all();
  }

  void fail(const CommandError& error) {
    {
      const std::lock_guard lock(mutex_);
      failure_ = {error.kind(), error.what()};
    }
    answered_.notify_all();
  }

  /// The answer. Throws CommandError when the command failed or took longer than `patience`.
  T wait(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    if (!answered_.wait_for(lock, patience, [this] { return value_ || failure_; })) {
      withdrawn_ = true;
      throw CommandError(CommandError::Kind::timeout,
                         claimed_ ? "the command takes longer than expected and is still under way"
                                  : "the simulation did not come to the command; it is withdrawn");
    }
    if (failure_) throw CommandError(failure_->kind, failure_->detail);
    return std::move(*value_);
  }

 private:
  struct Failure {
    CommandError::Kind kind;
    std::string detail;
  };

  std::mutex mutex_;
  std::condition_variable answered_;
  std::optional<T> value_;
  std::optional<Failure> failure_;
  bool claimed_ = false;
  bool withdrawn_ = false;
};

}  // namespace stagger::server
