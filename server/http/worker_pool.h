// Threads for requests, and what happens when there are more requests than threads.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace stagger::server {

/// What came last is served first. That makes no difference while there are threads enough; when
/// there are not, the newest is the one who still waits for an answer, and a crowd that was here
/// before it does not stand in its way. Who comes again at once gets few of the threads: all of
/// them would be much of the machine. Of the threads, too, the last one to fall asleep is the first
/// to be woken: it is at hand in the caches, and the stacks of those that are never needed at a
/// time take no memory.
template <typename T>
class WorkerPool {
 public:
  struct Size {
    std::size_t threads = 1;
    std::size_t threads_for_more = 1;  ///< of them, for add_more()
    std::size_t room = 1;              ///< for items that wait
  };

  WorkerPool(const Size& size, std::function<void(T)> serve)
      : size_(size), idle_(size.threads), serve_(std::move(serve)) {
    threads_.reserve(size.threads);
    for (std::size_t i = 0; i < size.threads; ++i) threads_.emplace_back([this] { run(); });
  }
  ~WorkerPool() { stop(); }
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Serves the item in one of the threads. Returns the one that has waited longest when it had to
  /// make room, and the item itself after stop().
  std::optional<T> add(T item) {
    std::optional<T> left_out;
    {
      const std::lock_guard lock(mutex_);
      if (stopped_) return item;
      // Items for which a thread is about to wake up take no room.
      if (fresh_.size() >= size_.room + idle_) {
        left_out = std::move(fresh_.front());
        fresh_.pop_front();
      }
      fresh_.push_back(std::move(item));
      wake_one();
    }
    return left_out;
  }

  /// The same behind all others, for who has been served just now and wants more. Returns the item
  /// when there is no room.
  std::optional<T> add_more(T item) {
    const std::lock_guard lock(mutex_);
    if (stopped_ || more_.size() >= size_.room) return item;
    more_.push_back(std::move(item));
    wake_one();
    return std::nullopt;
  }

  /// Items that wait for a thread.
  std::size_t waiting() const {
    const std::lock_guard lock(mutex_);
    return fresh_.size() + more_.size();
  }

  /// Serves what waits and ends the threads. May be called again.
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
      while (!asleep_.empty()) wake_one();
    }
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

 private:
  struct Sleeper {
    std::condition_variable changed;
    bool is_woken = false;
  };

  // All below: with mutex_ held.
  void wake_one() {
    if (asleep_.empty()) return;  // who is awake looks for items before it sleeps
    asleep_.back()->is_woken = true;
    asleep_.back()->changed.notify_one();
    asleep_.pop_back();
  }

  void sleep(Sleeper& sleeper, std::unique_lock<std::mutex>& lock) {
    sleeper.is_woken = false;
    asleep_.push_back(&sleeper);
    sleeper.changed.wait(lock, [&sleeper] { return sleeper.is_woken; });
  }

  bool may_serve_more() const { return !more_.empty() && serving_more_ < size_.threads_for_more; }

  void run() {
    Sleeper sleeper;
    std::unique_lock lock(mutex_);
    for (;;) {
      if (!fresh_.empty()) {
        serve_one(
            fresh_.back(), [this] { fresh_.pop_back(); }, lock);
      } else if (may_serve_more()) {
        ++serving_more_;
        serve_one(
            more_.front(), [this] { more_.pop_front(); }, lock);
        --serving_more_;
        if (may_serve_more()) wake_one();
      } else if (!stopped_) {
        sleep(sleeper, lock);
      } else {
        return;
      }
    }
  }

  template <typename Pop>
  void serve_one(T& place, Pop pop, std::unique_lock<std::mutex>& lock) {
    T item = std::move(place);
    pop();
    --idle_;
    lock.unlock();
    serve_(std::move(item));
    lock.lock();
    ++idle_;
  }

  const Size size_;
  mutable std::mutex mutex_;
  std::vector<Sleeper*> asleep_;  // the latest last
  std::deque<T> fresh_;           // newest last
  std::deque<T> more_;            // newest last
  std::size_t idle_;              // threads
  std::size_t serving_more_ = 0;
  bool stopped_ = false;
  const std::function<void(T)> serve_;
  std::vector<std::thread> threads_;
};

}  // namespace stagger::server
