#include "server/live/subscriber.h"

#include <algorithm>
#include <utility>

#include "server/live/decimation.h"
#include "sim/simulation.h"

namespace stagger::server {
namespace {

// A second of frames: more would only make a slow client see an older past.
std::size_t capacity_for(const Subscription& subscription) {
  const double fastest = *std::max_element(subscription.rates.begin(), subscription.rates.end());
  return static_cast<std::size_t>(std::clamp(fastest, 64.0, 1000.0));
}

RateMask all_rates(const Subscription& subscription) {
  return static_cast<RateMask>((1U << subscription.rates.size()) - 1U);
}

RateMask due_rates(const Subscription& subscription, std::uint64_t tick) {
  unsigned due = 0;
  for (std::size_t i = 0; i < subscription.rates.size(); ++i) {
    if (is_due(tick, subscription.rates[i], sim::Simulation::tick_s)) due |= 1U << i;
  }
  return static_cast<RateMask>(due);
}

}  // namespace

void Subscriber::start_session(SessionPtr session) {
  {
    const std::lock_guard lock(mutex_);
    session_ = session;
    last_.reset();
    add_lossless(std::move(session));
  }
  changed_.notify_all();
}

std::size_t Subscriber::offer(const FramePtr& frame, bool always) {
  std::size_t dropped = 0;
  {
    const std::lock_guard lock(mutex_);
    if (subscription_ == nullptr || frame->session != session_) return 0;
    if (frame == last_) return 0;
    const RateMask due =
        always ? all_rates(*subscription_) : due_rates(*subscription_, frame->frame.tick);
    if (due == 0) return 0;
    dropped = add_frame(frame, due);
  }
  changed_.notify_all();
  return dropped;
}

void Subscriber::offer(EventPtr event) {
  {
    const std::lock_guard lock(mutex_);
    if (subscription_ == nullptr || !subscription_->events) return;
    add_lossless(std::move(event));
  }
  changed_.notify_all();
}

void Subscriber::subscribe(Subscription subscription, std::string answer, const FramePtr& latest) {
  {
    const std::lock_guard lock(mutex_);
    subscription_ = std::make_shared<const Subscription>(std::move(subscription));
    add_lossless(ReplyItem{std::move(answer)});
    // A latecomer sees the present at once, also while the simulation is paused.
    if (latest != nullptr && latest->session == session_ &&
        (last_ == nullptr || last_->frame.tick <= latest->frame.tick)) {
      add_frame(latest, all_rates(*subscription_));
    }
  }
  changed_.notify_all();
}

void Subscriber::reply(std::string text) {
  {
    const std::lock_guard lock(mutex_);
    add_lossless(ReplyItem{std::move(text)});
  }
  changed_.notify_all();
}

void Subscriber::finish() {
  {
    const std::lock_guard lock(mutex_);
    finished_ = true;
  }
  changed_.notify_all();
}

std::optional<StreamItem> Subscriber::next(std::chrono::steady_clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  const bool ready = changed_.wait_until(lock, deadline, [this] {
    return finished_ || close_ || !lossless_.empty() || !frames_.empty();
  });
  if (!ready || finished_) return std::nullopt;
  if (close_) return StreamItem(std::move(*std::exchange(close_, std::nullopt)));
  const bool frame_first =
      lossless_.empty() || (!frames_.empty() && frames_.front().first < lossless_.front().first);
  StreamItem item = frame_first ? StreamItem(std::move(frames_.front().second))
                                : std::move(lossless_.front().second);
  frame_first ? frames_.pop_front() : lossless_.pop_front();
  return item;
}

bool Subscriber::finished() const {
  const std::lock_guard lock(mutex_);
  return finished_;
}

bool Subscriber::wait_until_finished(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, patience, [this] { return finished_; });
}

void Subscriber::close(int code, std::string reason) {
  {
    const std::lock_guard lock(mutex_);
    if (!close_) close_ = CloseItem{code, std::move(reason)};
  }
  changed_.notify_all();
}

std::uint64_t Subscriber::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

bool Subscriber::overflowed() const {
  const std::lock_guard lock(mutex_);
  return overflowed_;
}

void Subscriber::add_lossless(StreamItem item) {
  if (lossless_.size() >= max_lossless) {
    overflowed_ = true;
    if (!close_) close_ = CloseItem{1013, "too slow: events pile up"};
    return;
  }
  lossless_.emplace_back(next_order_++, std::move(item));
}

std::size_t Subscriber::add_frame(const FramePtr& frame, RateMask due) {
  last_ = frame;
  frames_.emplace_back(next_order_++, DataItem{frame, subscription_, next_seq_++, due});
  if (frames_.size() <= capacity_for(*subscription_)) return 0;
  frames_.pop_front();
  ++dropped_;
  return 1;
}

}  // namespace stagger::server
