// Hands frames and events from the simulation thread to every client's queue.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/live/messages.h"
#include "server/live/session_listener.h"
#include "server/live/subscriber.h"

namespace stagger::server {

struct StreamCounters {
  std::size_t clients = 0;
  std::uint64_t dropped_clients = 0;
  std::uint64_t dropped_messages = 0;
};

class FrameHub {
 public:
  /// Before the session starts; the listener outlives it. At most one.
  void set_listener(SessionListener& listener) { listener_ = &listener; }

  // The simulation thread's side.
  void start_session(SessionPtr session);
  /// A tick has been run; publish() shows it.
  void record(const FramePtr& frame);
  void publish(FramePtr frame, bool always);
  void publish(const EventPtr& event);
  void set_running(bool running) { running_ = running; }
  /// Before ticks that do not keep to the clock: so that none of them is lost to the listener.
  void await_room(std::chrono::milliseconds patience);

  // From any thread.
  /// Something that is no part of the world: clients are told, recordings are not.
  void announce(const EventPtr& event);

  // The clients' side.
  std::shared_ptr<Subscriber> add();
  void remove(const std::shared_ptr<Subscriber>& subscriber);
  /// A client was disconnected because it took nothing.
  void count_dropped_client() { ++dropped_clients_; }
  SessionPtr session() const;
  FramePtr latest() const;
  bool running() const { return running_; }
  StreamCounters counters() const;
  /// Tells every client to go, and every one that comes later.
  void close_all(int code, const std::string& reason);

 private:
  SessionListener* listener_ = nullptr;
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<Subscriber>> subscribers_;
  SessionPtr session_;
  FramePtr latest_;
  std::optional<CloseItem> closed_;
  std::atomic<bool> running_{true};
  std::atomic<std::uint64_t> dropped_clients_{0};
  std::atomic<std::uint64_t> dropped_messages_{0};
};

}  // namespace stagger::server
