// One client of the stream: a thread that reads, a thread that writes.
#pragma once

#include "server/http/stream_socket.h"
#include "server/live/frame_hub.h"

namespace stagger::server {

/// Serves the client until it leaves, is too slow, does not behave, or the hub closes.
void serve_stream(StreamSocket& socket, FrameHub& hub);

}  // namespace stagger::server
