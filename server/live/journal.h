// What has changed a world since its start. Written by the simulation thread, read by any.
#pragma once

#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

#include "sim/world_command.h"

namespace stagger::server {

class Journal {
 public:
  /// More than this is not kept, so that a world of weeks stays bounded (some 40 MB).
  static constexpr std::size_t capacity = 250000;

  void add(std::uint64_t tick, sim::WorldCommand command) {
    const std::lock_guard lock(mutex_);
    if (entries_.size() < capacity) {
      entries_.push_back({tick, std::move(command)});
    } else {
      complete_ = false;
    }
  }

  /// The entries from the one at `first` on, of ticks up to `last_tick`; oldest first.
  std::vector<sim::JournalEntry> entries(std::size_t first = 0,
                                         std::uint64_t last_tick = ~0ULL) const {
    const std::lock_guard lock(mutex_);
    std::vector<sim::JournalEntry> result;
    for (std::size_t i = first; i < entries_.size() && entries_[i].tick <= last_tick; ++i) {
      result.push_back(entries_[i]);
    }
    return result;
  }

  /// False once a command came that was not kept: the world cannot be made again from then on.
  bool complete() const {
    const std::lock_guard lock(mutex_);
    return complete_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<sim::JournalEntry> entries_;
  bool complete_ = true;
};

}  // namespace stagger::server
