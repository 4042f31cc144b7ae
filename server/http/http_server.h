// The HTTP and WebSocket server. The HTTP library is seen by http_server.cpp alone.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "server/http/router.h"
#include "server/http/stream_socket.h"

namespace stagger::server {

struct HttpServerOptions {
  std::string host = "127.0.0.1";
  int port = 8080;  ///< 0: any free one
  std::string stream_path = "/api/v1/stream";
  std::size_t stream_clients = 64;  ///< most at a time; the next one is answered 503
};

class HttpServer {
 public:
  /// Serves one stream client; the connection is closed when it returns.
  using StreamHandler = std::function<void(StreamSocket&)>;

  /// Listens, but does not answer yet. Throws std::runtime_error when the address cannot be had.
  HttpServer(const HttpServerOptions& options, Router router, StreamHandler serve_stream);
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
