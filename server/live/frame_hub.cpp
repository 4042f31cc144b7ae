#include "server/live/frame_hub.h"

#include <algorithm>

namespace stagger::server {

void FrameHub::start_session(SessionPtr session) {
  if (listener_ != nullptr) listener_->start_session(session);
  const std::lock_guard lock(mutex_);
  session_ = std::move(session);
  latest_.reset();
  for (const auto& subscriber : subscribers_) subscriber->start_session(session_);
}

void FrameHub::publish(FramePtr frame, bool always) {
  const std::lock_guard lock(mutex_);
  latest_ = std::move(frame);
  for (const auto& subscriber : subscribers_) {
    dropped_messages_ += subscriber->offer(latest_, always);
  }
}

void FrameHub::record(const FramePtr& frame) {
  if (listener_ != nullptr) listener_->tick(frame);
}

void FrameHub::await_room(std::chrono::milliseconds patience) {
  if (listener_ != nullptr) listener_->await_room(patience);
}

void FrameHub::publish(const EventPtr& event) {
  if (listener_ != nullptr) listener_->event(event);
  announce(event);
}

void FrameHub::announce(const EventPtr& event) {
  const std::lock_guard lock(mutex_);
  for (const auto& subscriber : subscribers_) subscriber->offer(event);
}

std::shared_ptr<Subscriber> FrameHub::add() {
  auto subscriber = std::make_shared<Subscriber>();
  const std::lock_guard lock(mutex_);
  if (closed_) subscriber->close(closed_->code, closed_->reason);
  if (session_ != nullptr) subscriber->start_session(session_);
  subscribers_.push_back(subscriber);
  return subscriber;
}

void FrameHub::remove(const std::shared_ptr<Subscriber>& subscriber) {
  const std::lock_guard lock(mutex_);
  std::erase(subscribers_, subscriber);
}

SessionPtr FrameHub::session() const {
  const std::lock_guard lock(mutex_);
  return session_;
}

FramePtr FrameHub::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

StreamCounters FrameHub::counters() const {
  const std::lock_guard lock(mutex_);
  return {subscribers_.size(), dropped_clients_, dropped_messages_};
}

void FrameHub::close_all(int code, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  closed_ = CloseItem{code, reason};
  for (const auto& subscriber : subscribers_) subscriber->close(code, reason);
}

}  // namespace stagger::server
