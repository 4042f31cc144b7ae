// The messages of docs/stream.md.
#pragma once

#include <cstdint>
#include <string>

#include "server/json/json.h"
#include "server/live/messages.h"
#include "sim/strict_json.h"

namespace stagger::server {

/// The table of channels, as hello tells it.
Json channels_json(const std::vector<sim::Channel>& channels);

std::string hello_text(const SessionInfo& session);
std::string event_text(const EventMessage& event);
std::string error_text(const std::string& detail);
std::string heartbeat_text(std::uint64_t tick, double time, bool running, std::uint64_t dropped);
std::string subscribed_text(const Subscription& subscription, const SessionInfo& session);

/// What the client asks for. What is wrong goes to `errors`, names of channels included.
Subscription read_subscription(const std::string& text, const SessionInfo& session,
                               sim::JsonErrors& errors);

}  // namespace stagger::server
