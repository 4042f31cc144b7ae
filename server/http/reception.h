// Where connections wait that have nothing to be served yet: one thread for all of them.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <unordered_map>

#include "server/http/connection.h"

namespace stagger::server {

/// A thread for each connection would be at the mercy of whoever opens connections and says
/// nothing, or a byte a minute. Here such a client costs a descriptor; a thread is asked for when a
/// request has come in, with its body where that is short. When the room is full, who has waited
/// longest goes: an honest client has spoken long before.
class Reception {
 public:
  using ConnectionPtr = std::shared_ptr<Connection>;
  /// The request is whole or begun.
  using Serve = std::function<void(ConnectionPtr, Connection::Request)>;

  /// For a request, from the connection's opening or from the last answer.
  static constexpr std::chrono::seconds request_patience{10};
  /// For the rest of what a client sends whose request has been cut short by an answer.
  static constexpr std::chrono::seconds drain_patience{1};
  /// How often `each_turn` is called at least.
  static constexpr std::chrono::milliseconds turn{100};

  /// `serve` is called in this object's thread and must not wait.
  Reception(std::size_t room, Serve serve, std::function<void()> each_turn);
  ~Reception();
  Reception(const Reception&) = delete;
  Reception& operator=(const Reception&) = delete;

  // From any thread; none waits for a client.
  void await_request(const ConnectionPtr& connection);
  /// To close with data unread would destroy the answer on its way.
  void drain(const ConnectionPtr& connection);
  /// Lets go of all connections and ends the thread. May be called again.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;
  struct Guest {
    ConnectionPtr connection;
    bool draining = false;
  };
  using Guests = std::multimap<Clock::time_point, Guest>;  // by the end of their time

  void add(const ConnectionPtr& connection, bool draining);
  void run();
  void look_at(int socket);
  void dismiss_the_late();
  Guest remove(Guests::iterator guest);

  const std::size_t room_;
  const Serve serve_;
  const std::function<void()> each_turn_;
  const int epoll_;
  std::mutex mutex_;
  Guests guests_;
  std::unordered_map<int, Guests::iterator> by_socket_;
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace stagger::server
