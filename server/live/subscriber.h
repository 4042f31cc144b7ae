// The bounded queue between the simulation thread and the one thread that writes to one client.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <variant>

#include "server/live/messages.h"

namespace stagger::server {

/// A frame for one client, under the subscription that it was taken for.
struct DataItem {
  FramePtr frame;
  SubscriptionPtr subscription;
  std::uint64_t seq = 0;
  RateMask due = 1;  ///< which of the subscription's rates it is taken for
};

/// The text of an answer to something that the client said.
struct ReplyItem {
  std::string text;
};

/// The last item: close with this code.
struct CloseItem {
  int code = 1000;
  std::string reason;
};

using StreamItem = std::variant<SessionPtr, DataItem, EventPtr, ReplyItem, CloseItem>;

/// Frames are dropped, oldest first, when the client is slow; everything else is kept in order, and
/// a client for whom too much of that piles up is told to go.
class Subscriber {
 public:
  static constexpr std::size_t max_lossless = 1024;

  // The simulation thread's side; none of these waits for the client.
  void start_session(SessionPtr session);
  /// `always`: also when the tick is not due (after a pause, a step, a reset).
  /// Returns how many frames had to be dropped for it: 0 or 1.
  std::size_t offer(const FramePtr& frame, bool always);
  void offer(EventPtr event);

  // The side of the thread that reads from the client.
  /// Replaces the subscription, queues the answer and the latest frame.
  void subscribe(Subscription subscription, std::string answer, const FramePtr& latest);
  void reply(std::string text);
  /// Nothing more can be read from the client: the writer is to end.
  void finish();

  // The writer's side.
  /// The next item, or nothing when the deadline has passed or finish() has been called.
  std::optional<StreamItem> next(std::chrono::steady_clock::time_point deadline);
  bool finished() const;
  /// True when finish() was called within that time.
  bool wait_until_finished(std::chrono::milliseconds patience);

  /// Queues a close in front of everything else. Any thread.
  void close(int code, std::string reason);
  std::uint64_t dropped() const;
  /// True once the events have overflowed.
  bool overflowed() const;

 private:
  void add_lossless(StreamItem item);
  std::size_t add_frame(const FramePtr& frame, RateMask due);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t next_order_ = 0;
  std::deque<std::pair<std::uint64_t, StreamItem>> lossless_;
  std::deque<std::pair<std::uint64_t, DataItem>> frames_;
  std::optional<CloseItem> close_;
  SessionPtr session_;
  SubscriptionPtr subscription_;
  FramePtr last_;  ///< of this session's frames that was queued
  std::uint64_t next_seq_ = 0;
  std::uint64_t dropped_ = 0;
  bool overflowed_ = false;
  bool finished_ = false;
};

}  // namespace stagger::server
