// What a Prometheus server reads at /metrics.
#pragma once

#include <memory>
#include <string>

#include "server/http/message.h"
#include "server/live/frame_hub.h"
#include "server/live/live_session.h"

namespace stagger::server {

/// Safe to use from several threads.
class ServerMetrics {
 public:
  ServerMetrics(const LiveSession& session, const FrameHub& hub);
  ~ServerMetrics();
  ServerMetrics(const ServerMetrics&) = delete;
  ServerMetrics& operator=(const ServerMetrics&) = delete;

  void count(const RequestSummary& request);
  /// Everything, as Prometheus's text format. Never waits for the simulation.
  std::string text() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace stagger::server
