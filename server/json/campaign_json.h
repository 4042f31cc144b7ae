// A campaign of the server as JSON, and as an event of the stream.
#pragma once

#include "server/campaign/campaign_queue.h"
#include "server/json/json.h"
#include "server/live/messages.h"

namespace stagger::server {

Json campaign_json(const campaign::QueueItem& item);

/// At the tick of the live session that is the newest now.
EventPtr campaign_event(const campaign::QueueItem& item, std::uint64_t tick, double time_s);

}  // namespace stagger::server
