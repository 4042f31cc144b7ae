// A bounded queue from many threads to one, which never waits for longer than a push or a swap.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

namespace stagger::server {

template <typename T>
class CommandQueue {
 public:
  explicit CommandQueue(std::size_t capacity) : capacity_(capacity) {}

  enum class Push { taken, full, closed };

  Push push(T item) {
    {
      const std::lock_guard lock(mutex_);
      if (closed_) return Push::closed;
      if (items_.size() >= capacity_) return Push::full;
      items_.push_back(std::move(item));
    }
    changed_.notify_one();
    return Push::taken;
  }

  /// Everything that waits, oldest first; also after the queue has been closed.
  std::vector<T> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(items_, {});
  }

  /// Returns when there is something to take, when the queue is closed (both: true), or after
  /// `patience`.
  bool wait(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, patience, [this] { return closed_ || !items_.empty(); });
  }

  /// From now on nothing is accepted.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return items_.size();
  }

  bool closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<T> items_;
  bool closed_ = false;
};

}  // namespace stagger::server
