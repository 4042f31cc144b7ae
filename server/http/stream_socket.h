// A WebSocket as the stream sees it: nothing of the HTTP library shows here.
#pragma once

#include <string>

namespace stagger::server {

/// One thread reads, one other thread sends.
class StreamSocket {
 public:
  enum class Sent {
    yes,
    gone,    ///< the client has left
    stalled  ///< the client has taken nothing for too long
  };

  StreamSocket() = default;
  StreamSocket(const StreamSocket&) = delete;
  StreamSocket& operator=(const StreamSocket&) = delete;
  virtual ~StreamSocket() = default;

  /// Waits for the next text; false when the client has left, or has been silent for 10 s in spite
  /// of pings.
  virtual bool read(std::string& text) = 0;
  /// Blocks for 2 s at most; after anything but `yes` the socket is of no more use.
  virtual Sent send(const std::string& text) = 0;
  virtual Sent send_binary(const std::string& bytes) = 0;
  virtual Sent ping() = 0;
  /// Sends a close frame; the client then closes too, which ends read().
  virtual void close(int code, const std::string& reason) = 0;
  /// Ends read() and send() in both threads at once. Any thread.
  virtual void shut_down() = 0;
};

}  // namespace stagger::server
