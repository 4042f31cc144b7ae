#include "server/http/reception.h"

#include <sys/epoll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace stagger::server {

Reception::Reception(std::size_t room, Serve serve, std::function<void()> each_turn)
    : room_(room),
      serve_(std::move(serve)),
      each_turn_(std::move(each_turn)),
      epoll_(epoll_create1(EPOLL_CLOEXEC)) {
  if (epoll_ < 0) throw std::system_error(errno, std::generic_category(), "epoll_create1");
  thread_ = std::thread([this] { run(); });
}

Reception::~Reception() {
  stop();
  ::close(epoll_);
}

void Reception::await_request(const ConnectionPtr& connection) { add(connection, false); }

void Reception::drain(const ConnectionPtr& connection) { add(connection, true); }

void Reception::stop() {
  Guests leaving;  // closed without the lock
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    leaving.swap(guests_);
    by_socket_.clear();
  }
  if (thread_.joinable()) thread_.join();
}

void Reception::add(const ConnectionPtr& connection, bool draining) {
  const int socket = connection->socket();
  Guest oldest;
  {
    const std::lock_guard lock(mutex_);
    if (stopped_) return;
    if (guests_.size() >= room_) oldest = remove(guests_.begin());
    const auto patience = draining ? drain_patience : request_patience;
    const auto guest = guests_.emplace(Clock::now() + patience, Guest{connection, draining});
    by_socket_[socket] = guest;
    // What has come already is told at once.
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = socket;
    if (epoll_ctl(epoll_, EPOLL_CTL_ADD, socket, &event) != 0) remove(guest);
  }
}

void Reception::run() {
  std::array<epoll_event, 64> events;
  constexpr auto patience = static_cast<int>(turn.count());
  auto next_turn = Clock::now() + turn;
  for (;;) {
    const int count = epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), patience);
    {
      const std::lock_guard lock(mutex_);
      if (stopped_) return;
    }
    for (int i = 0; i < count; ++i) look_at(events[static_cast<std::size_t>(i)].data.fd);
    if (Clock::now() < next_turn) continue;
    next_turn = Clock::now() + turn;
    dismiss_the_late();
    each_turn_();
  }
}

void Reception::look_at(int socket) {
  Guest leaving;
  auto request = Connection::Request::gone;
  {
    const std::lock_guard lock(mutex_);
    const auto found = by_socket_.find(socket);
    if (found == by_socket_.end()) return;
    const Guest& guest = found->second->second;
    if (guest.draining) {
      if (guest.connection->swallow()) return;
    } else {
      request = guest.connection->take_in();
      if (request == Connection::Request::incomplete) return;
    }
    leaving = remove(found->second);
  }
  if (request != Connection::Request::gone) serve_(std::move(leaving.connection), request);
}

void Reception::dismiss_the_late() {
  const auto now = Clock::now();
  for (;;) {
    Guest late;
    const std::lock_guard lock(mutex_);
    if (guests_.empty() || guests_.begin()->first > now) return;
    late = remove(guests_.begin());
  }
}

Reception::Guest Reception::remove(Guests::iterator guest) {
  Guest leaving = std::move(guest->second);
  const int socket = leaving.connection->socket();
  epoll_ctl(epoll_, EPOLL_CTL_DEL, socket, nullptr);
  by_socket_.erase(socket);
  guests_.erase(guest);
  return leaving;
}

}  // namespace stagger::server
