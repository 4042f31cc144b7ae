#include "server/http/connection.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "server/http/request_head.h"

namespace stagger::server {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::milliseconds;

constexpr Milliseconds request_patience{30000};
constexpr std::size_t swallow_bytes = 16 << 20;
// More would only hide from us, for a while, that the client takes nothing.
constexpr int websocket_send_buffer = 256 * 1024;

bool wait_for(int socket, short events, Milliseconds patience) {
  const auto end = Clock::now() + patience;
  for (;;) {
    const auto left = std::chrono::duration_cast<Milliseconds>(end - Clock::now());
    pollfd descriptor{socket, events, 0};
    const int ready = poll(&descriptor, 1, static_cast<int>(std::max<long>(left.count(), 0)));
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

// Length of the whole WebSocket frame that starts with these bytes, or 0 when they are too few.
// Frames from a server have no mask.
std::size_t frame_length(const std::string& bytes) {
  if (bytes.size() < 2) return 0;
  const auto byte = [&bytes](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const std::size_t first = byte(1) & 0x7fU;
  const std::size_t header = first < 126 ? 2 : first == 126 ? 4 : 10;
  if (bytes.size() < header) return 0;
  if (first < 126) return header + first;
  std::size_t length = 0;
  for (std::size_t i = 2; i < header; ++i) length = (length << 8) | byte(i);
  return header + length;
}

}  // namespace

Connection::Request Connection::take_in() {
  if (start_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + start_, end_ - start_);
    end_ -= std::exchange(start_, 0);
    searched_ = wanted_ = 0;
  }
  for (;;) {
    const Request request = look_at_buffer();
    if (request != Request::incomplete) return request;
    const ssize_t count = recv(socket_, buffer_.data() + end_, buffer_.size() - end_, MSG_DONTWAIT);
    if (count > 0) {
      end_ += static_cast<std::size_t>(count);
    } else if (count < 0 && errno == EINTR) {
      continue;
    } else {
      const bool nothing_yet = count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
      if (nothing_yet) return Request::incomplete;
      return wanted_ > 0 ? Request::begun : Request::gone;  // a body cut short is worth an answer
    }
  }
}

Connection::Request Connection::look_at_buffer() {
  constexpr std::string_view head_end = "\r\n\r\n";
  if (wanted_ == 0) {
    const std::string_view come(buffer_.data(), end_);
    // The end may begin in what came before.
    const std::size_t found = come.find(head_end, searched_ < 3 ? 0 : searched_ - 3);
    searched_ = end_;
    if (found == std::string_view::npos) {
      return end_ == buffer_.size() ? Request::begun : Request::incomplete;
    }
    const std::size_t head = found + head_end.size();
    const auto body = body_length(come.substr(0, head));
    if (!body || *body > buffer_.size() - head) return Request::begun;
    wanted_ = head + *body;
  }
  return end_ >= wanted_ ? Request::whole : Request::incomplete;
}

void Connection::begin_request() { request_begin_ = Clock::now(); }

bool Connection::is_slow(Clock::time_point since) const {
  return waits_ && !websocket_ && request_begin_.load() <= since;
}

bool Connection::swallow() {
  while (swallowed_ < swallow_bytes) {
    const ssize_t count = recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (count > 0) {
      swallowed_ += static_cast<std::size_t>(count);
    } else if (count == 0 || errno != EINTR) {
      return count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
    }
  }
  return false;
}

bool Connection::wait_readable() const {
  if (has_buffered()) return true;
  Milliseconds patience = read_timeout_;
  if (!websocket_) {
    const auto end = request_begin_.load() + request_patience;
    const auto left = std::chrono::duration_cast<Milliseconds>(end - Clock::now());
    patience = std::clamp(left, Milliseconds(0), patience);
  }
  waits_ = true;
  const bool ready = wait_for(socket_, POLLIN, patience);
  waits_ = false;
  return ready;
}

bool Connection::wait_writable() const {
  waits_ = true;
  const bool ready = wait_for(socket_, POLLOUT, write_patience);
  waits_ = false;
  return ready;
}

ssize_t Connection::read(char* data, std::size_t size) {
  if (!websocket_) return read_some(data, size);
  // The library's frame reader takes a short read for a broken stream.
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = read_some(data + done, size - done);
    if (count <= 0) return count;
    done += static_cast<std::size_t>(count);
  }
  return static_cast<ssize_t>(done);
}

ssize_t Connection::read_some(char* data, std::size_t size) {
  if (!has_buffered()) {
    if (!wait_readable()) return -1;
    ssize_t count = 0;
    do {
      count = recv(socket_, buffer_.data(), buffer_.size(), 0);
    } while (count < 0 && errno == EINTR);
    if (count <= 0) return count;
    start_ = 0;
    end_ = static_cast<std::size_t>(count);
    searched_ = wanted_ = 0;
  }
  const std::size_t count = std::min(size, end_ - start_);
  std::memcpy(data, buffer_.data() + start_, count);
  start_ += count;
  return static_cast<ssize_t>(count);
}

ssize_t Connection::write(const char* data, std::size_t size) {
  const auto done = static_cast<ssize_t>(size);
  if (!websocket_) {
    const std::lock_guard lock(write_mutex_);
    return send_all(data, size) ? done : -1;
  }
  frame_.append(data, size);
  const std::size_t length = frame_length(frame_);
  if (length == 0 || frame_.size() < length) return done;
  const std::lock_guard lock(write_mutex_);
  const bool sent = closing_ || send_all(frame_.data(), frame_.size());
  frame_.clear();
  return sent ? done : -1;
}

void Connection::become_websocket() {
  websocket_ = true;
  setsockopt(socket_, SOL_SOCKET, SO_SNDBUF, &websocket_send_buffer, sizeof websocket_send_buffer);
}

bool Connection::send_control(Control kind, const std::string& payload) {
  std::string frame{static_cast<char>(0x80U | static_cast<unsigned>(kind)),
                    static_cast<char>(std::min<std::size_t>(payload.size(), 125))};
  frame += payload.substr(0, 125);
  const std::lock_guard lock(write_mutex_);
  if (closing_) return true;
  if (kind == Control::close) closing_ = true;
  return send_all(frame.data(), frame.size());
}

bool Connection::send_all(const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t count = send(socket_, data, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count > 0) {
      data += count;
      size -= static_cast<std::size_t>(count);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (!wait_writable()) {
        stalled_ = true;
        return false;
      }
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

void Connection::shut_down() const { shutdown(socket_, SHUT_RDWR); }

void Connection::try_write(std::string_view text) const {
  // Whether it arrives or not, the connection ends.
  [[maybe_unused]] const ssize_t sent =
      send(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

void Connection::end_writing() const { shutdown(socket_, SHUT_WR); }

ConnectionRegistry::Entry::Entry(ConnectionRegistry& registry, Connection& connection)
    : registry_(registry), connection_(connection) {
  const std::lock_guard lock(registry_.mutex_);
  registry_.open_.insert(&connection_);
  if (registry_.closed_) connection_.shut_down();
}

ConnectionRegistry::Entry::~Entry() {
  const std::lock_guard lock(registry_.mutex_);
  registry_.open_.erase(&connection_);
}

void ConnectionRegistry::shut_down_all() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  for (Connection* connection : open_) connection->shut_down();
}

std::size_t ConnectionRegistry::cut_slowest(std::size_t count, Clock::time_point since) {
  const std::lock_guard lock(mutex_);
  std::vector<std::pair<Clock::time_point, Connection*>> slow;
  for (Connection* connection : open_) {
    if (connection->is_slow(since)) slow.emplace_back(connection->request_begin(), connection);
  }
  const std::size_t cut = std::min(count, slow.size());
  std::partial_sort(slow.begin(), slow.begin() + static_cast<std::ptrdiff_t>(cut), slow.end());
  for (std::size_t i = 0; i < cut; ++i) slow[i].second->shut_down();
  return cut;
}

}  // namespace stagger::server
