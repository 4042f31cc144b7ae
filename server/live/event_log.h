// What has happened in this session, for whoever asks later. Bounded: the oldest go first.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/live/messages.h"

namespace stagger::server {

/// An event with its number, which no other one of this server has.
struct LoggedEvent {
  std::uint64_t id = 0;
  EventPtr event;
};

struct EventQuery {
  std::uint64_t before = ~0ULL;  ///< ids below this
  std::size_t limit = 100;
  std::optional<std::string> kind;
  std::uint64_t since_tick = 0;
};

/// Written by the simulation thread, read by any.
class EventLog {
 public:
  static constexpr std::size_t capacity = 10000;

  void add(EventPtr event);
  /// A new session: ticks count from 0 again.
  void clear();
  /// Newest first.
  std::vector<LoggedEvent> find(const EventQuery& query) const;
  /// Events of this session that are no longer here.
  std::uint64_t forgotten() const;

 private:
  mutable std::mutex mutex_;
  std::deque<LoggedEvent> events_;
  std::uint64_t next_id_ = 1;
  std::uint64_t forgotten_ = 0;
};

}  // namespace stagger::server
