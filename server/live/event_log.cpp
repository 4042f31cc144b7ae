#include "server/live/event_log.h"

#include <utility>

namespace stagger::server {

void EventLog::add(EventPtr event) {
  const std::lock_guard lock(mutex_);
  events_.push_back({next_id_++, std::move(event)});
  if (events_.size() <= capacity) return;
  events_.pop_front();
  ++forgotten_;
}

void EventLog::clear() {
  const std::lock_guard lock(mutex_);
  events_.clear();
  forgotten_ = 0;
}

std::vector<LoggedEvent> EventLog::find(const EventQuery& query) const {
  const std::lock_guard lock(mutex_);
  std::vector<LoggedEvent> found;
  for (std::size_t i = events_.size(); i > 0 && found.size() < query.limit; --i) {
    const LoggedEvent& logged = events_[i - 1];
    const bool fits = logged.id < query.before && logged.event->tick >= query.since_tick &&
                      (!query.kind || *query.kind == logged.event->kind);
    if (fits) found.push_back(logged);
  }
  return found;
}

std::uint64_t EventLog::forgotten() const {
  const std::lock_guard lock(mutex_);
  return forgotten_;
}

}  // namespace stagger::server
