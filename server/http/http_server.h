// The HTTP and WebSocket server. The HTTP library is seen by http_server.cpp alone.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "server/http/access.h"
#include "server/http/router.h"
#include "server/http/security.h"
#include "server/http/stream_socket.h"

namespace stagger::server {

struct HttpServerOptions {
  std::string host = "127.0.0.1";
  int port = 8080;  ///< 0: any free one
  std::string stream_path = "/api/v1/stream";
  std::size_t stream_clients = 64;             ///< most at a time; the next one is answered 503
  double command_rate = 500.0;                 ///< [1/s] of one address; bursts of twice that
  Gatekeeper::Allowed allowed;                 ///< beside the server's own names
  std::string upload_path = "/api/v1/robots";  ///< takes greater bodies, as forms
};

class HttpServer {
 public:
  /// Serves one stream client; the connection is closed when it returns.
  using StreamHandler = std::function<void(StreamSocket&)>;

  /// Told of every answer, in the thread that gave it.
  using Counter = std::function<void(const RequestSummary&)>;

  /// Listens, but does not answer yet. Throws std::runtime_error when the address cannot be had.
  /// `access` outlives the server.
  HttpServer(const HttpServerOptions& options, Access& access, Router router,
             StreamHandler serve_stream, Counter count = {});
  ~HttpServer();

  int port() const;
  void start();
  /// No new connections; those that are open go on.
  void stop_listening();
  /// Ends every connection and returns when all threads have ended. May be called again.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace stagger::server
