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
#include <string_view>

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
  enum class Request : std::uint8_t {
    incomplete,
    whole,  ///< with its body
    begun,  ///< its head, and nobody knows but by reading when the rest will come
    gone    ///< the client has left
  };
  /// Takes in what has come of a request, as far as the buffer holds it. Never waits.
  Request take_in();
  /// A request is about to be read: from now on the rest of it has 30 s to arrive.
  void begin_request();
  /// In a request since at least then, and waiting for the client right now. Any thread.
  bool is_slow(std::chrono::steady_clock::time_point since) const;
  std::chrono::steady_clock::time_point request_begin() const { return request_begin_; }
  bool is_websocket() const { return websocket_; }
  /// Throws away what comes, without waiting; false at the end.
  bool swallow();
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
  /// What can be sent without waiting.
  void try_write(std::string_view text) const;
  /// Of this connection, the one that begins now included.
  int count_request() { return ++requests_; }
  /// Tells the client that nothing more comes.
  void end_writing() const;

 private:
  Request look_at_buffer();
  ssize_t read_some(char* data, std::size_t size);
  bool send_all(const char* data, std::size_t size);

  const int socket_;
  std::chrono::milliseconds read_timeout_{5000};
  std::atomic<std::chrono::steady_clock::time_point> request_begin_{};
  mutable std::atomic<bool> waits_{false};
  std::array<char, 16384> buffer_;
  std::size_t start_ = 0;
  std::size_t end_ = 0;
  std::size_t searched_ = 0;   ///< of the buffer: no end of a head in there
  std::size_t wanted_ = 0;     ///< in the buffer for a whole request; 0 while that is not known
  std::size_t swallowed_ = 0;  ///< [bytes]
  int requests_ = 0;
  std::atomic<bool> websocket_{false};
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
  /// Cuts off at most `count` clients that have let their request wait since `since`, the longest
  /// first. Returns how many.
  std::size_t cut_slowest(std::size_t count, std::chrono::steady_clock::time_point since);

 private:
  std::mutex mutex_;
  std::set<Connection*> open_;
  bool closed_ = false;
};

}  // namespace stagger::server
