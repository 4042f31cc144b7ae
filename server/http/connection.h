// One accepted socket: bounded reads and writes that another thread can end.
#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>

namespace stagger::server {

/// What the HTTP library's own stream lacks: a write that is cut short counts as an error (the
/// library takes it for a success, and everything after it is garbage), a WebSocket frame leaves in
/// one piece, a close frame can come from another thread than the one that reads, and everything
/// can be ended from outside. Does not own the descriptor.
class Connection {
 public:
  /// A client that takes nothing for this long is given up.
  static constexpr std::chrono::milliseconds write_patience{2000};

  explicit Connection(int socket) : socket_(socket) {}
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  int socket() const { return socket_; }
  /// Waits for the first byte of a request; from then on the whole request has 30 s to arrive.
  bool wait_for_request(std::chrono::milliseconds patience);
  bool has_buffered() const { return start_ < end_; }
  bool wait_readable() const;
  bool wait_writable() const;
  void set_read_timeout(std::chrono::milliseconds timeout) { read_timeout_ = timeout; }
  /// Bytes read; 0 at the end, -1 on errors and when the time is up.
  ssize_t read(char* data, std::size_t size);
  /// `size`, or -1.
  ssize_t write(const char* data, std::size_t size);

  /// From now on `write` collects whole WebSocket frames, and `read` fills all of its buffer.
  void become_websocket();
  enum class Control : std::uint8_t { close = 0x8, ping = 0x9 };
  /// A WebSocket control frame, from any thread. After a close frame nothing else is sent.
  bool send_control(Control kind, const std::string& payload);
  /// A write has failed because the client took nothing.
  bool stalled() const { return stalled_; }

  /// Ends what all threads do with the socket. The descriptor stays open.
  void shut_down() const;
  /// Tells the client that nothing more comes, and swallows what it still sends: to close with data
  /// unread would destroy the answer on its way.
  void linger();

 private:
  ssize_t read_some(char* data, std::size_t size);
  bool send_all(const char* data, std::size_t size);

  const int socket_;
  std::chrono::milliseconds read_timeout_{5000};
  std::chrono::steady_clock::time_point request_end_;
  std::array<char, 16384> buffer_;
  std::size_t start_ = 0;
  std::size_t end_ = 0;
  bool websocket_ = false;
  std::string frame_;  ///< what the library has written so far of a frame
  std::mutex write_mutex_;
  bool closing_ = false;
  std::atomic<bool> stalled_{false};
};

/// All open connections, so that the end of the server can end them.
class ConnectionRegistry {
 public:
  /// Held while a connection is open.
  class Entry {
   public:
    Entry(ConnectionRegistry& registry, Connection& connection);
    ~Entry();
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;

   private:
    ConnectionRegistry& registry_;
    Connection& connection_;
  };

  /// Shuts down all that are open and all that come later.
  void shut_down_all();

 private:
  std::mutex mutex_;
  std::set<Connection*> open_;
  bool closed_ = false;
};

}  // namespace stagger::server
