// The messages of docs/stream.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/live/messages.h"
#include "sim/strict_json.h"

namespace stagger::server {

std::string hello_text(const SessionInfo& session);
std::string event_text(const EventMessage& event);
std::string error_text(const std::string& detail);
std::string heartbeat_text(std::uint64_t tick, double time, bool running, std::uint64_t dropped);
std::string subscribed_text(const Subscription& subscription, const SessionInfo& session);

/// What the client asks for. What is wrong goes to `errors`, names of channels included.
Subscription read_subscription(const std::string& text, const SessionInfo& session,
                               sim::JsonErrors& errors);

/// Writes data messages for one client: finds the channels once for each subscription, and keeps
/// its buffers.
class DataWriter {
 public:
  const std::string& text(const FrameMessage& message, const SubscriptionPtr& subscription,
                          std::uint64_t seq);

 private:
  SessionPtr session_;
  SubscriptionPtr subscription_;
  std::vector<const sim::Channel*> channels_;
  std::vector<double> values_;
  std::string text_;
};

}  // namespace stagger::server
