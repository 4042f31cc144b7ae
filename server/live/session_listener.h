// Someone who is told of every tick, not just of the newest.
#pragma once

#include <chrono>

#include "server/live/messages.h"

namespace stagger::server {

/// All but await_room() return at once: it is the simulation thread that calls them.
class SessionListener {
 public:
  SessionListener() = default;
  SessionListener(const SessionListener&) = delete;
  SessionListener& operator=(const SessionListener&) = delete;
  virtual ~SessionListener() = default;

  virtual void start_session(const SessionPtr& session) = 0;
  /// Every tick, before its events.
  virtual void tick(const FramePtr& frame) = 0;
  virtual void event(const EventPtr& event) = 0;
  /// For a simulation that need not keep to the clock: returns once many ticks can be taken, or
  /// after `patience`.
  virtual void await_room(std::chrono::milliseconds patience) = 0;
};

}  // namespace stagger::server
