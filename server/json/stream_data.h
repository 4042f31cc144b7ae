// The data messages of docs/stream.md, as text and as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "server/live/messages.h"

namespace stagger::server {

/// A channel of a subscription, found in its session.
struct ChannelPick {
  const sim::Channel* channel = nullptr;
  std::size_t rate = 0;             ///< index in the subscription's rates
  std::vector<std::size_t> fields;  ///< indices of the components that are wanted, in that order
};

/// In the order in which the values come: that of hello.
using ChannelLayout = std::vector<ChannelPick>;

/// Channels and fields that the session does not have are left out. Points into the session.
ChannelLayout layout_of(const Subscription& subscription, const SessionInfo& session);

/// Appends the shortest text that reads back as the same number; null when it is not finite.
void append_number(std::string& text, double value);

/// Writes data messages for one client: finds the channels once for each subscription, and keeps
/// its buffers.
class DataWriter {
 public:
  /// The message in the subscription's format, with the channels of the rates that are `due`.
  const std::string& write(const FrameMessage& message, const SubscriptionPtr& subscription,
                           std::uint64_t seq, RateMask due = 1);

 private:
  void prepare(const FrameMessage& message, const SubscriptionPtr& subscription);
  void read(const ChannelPick& pick, const sim::Frame& frame);
  void write_text(const sim::Frame& frame, std::uint64_t seq, RateMask due);
  template <typename Number>
  void write_binary(const sim::Frame& frame, std::uint64_t seq, RateMask due);

  SessionPtr session_;
  SubscriptionPtr subscription_;
  ChannelLayout layout_;
  std::vector<double> all_;     ///< of a channel, before fields are chosen
  std::vector<double> values_;  ///< of a channel
  std::string message_;
};

}  // namespace stagger::server
