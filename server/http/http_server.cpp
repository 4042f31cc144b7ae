#include "server/http/http_server.h"

// Settings of the library; nobody else includes it, so that they hold everywhere.
#define CPPHTTPLIB_LISTEN_BACKLOG 128
// A dead client is noticed when it has answered no ping for this long.
#define CPPHTTPLIB_WEBSOCKET_READ_TIMEOUT_SECOND 10
// Above the 64 KiB that the stream takes: a message that is too long can still be answered.
#define CPPHTTPLIB_WEBSOCKET_MAX_PAYLOAD_LENGTH (1024 * 1024)
#include <httplib.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <utility>

#include "server/http/connection.h"
#include "server/http/problem.h"
#include "server/http/security.h"

namespace stagger::server {
namespace {

constexpr std::size_t max_body = 1 << 20;
constexpr std::size_t request_threads = 64;
constexpr std::size_t max_waiting_connections = 256;
constexpr int requests_per_connection = 1000;
// Longer would hold a thread for a client that has nothing to say.
constexpr std::chrono::seconds keep_alive_patience{1};

/// The library's view of a connection.
class LibraryStream final : public httplib::Stream {
 public:
  explicit LibraryStream(Connection& connection) : connection_(connection) {}
  bool is_readable() const override { return connection_.has_buffered(); }
  bool wait_readable() const override { return connection_.wait_readable(); }
  bool wait_writable() const override { return connection_.wait_writable(); }
  ssize_t read(char* data, size_t size) override { return connection_.read(data, size); }
  ssize_t write(const char* data, size_t size) override { return connection_.write(data, size); }
  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    httplib::detail::get_remote_ip_and_port(connection_.socket(), ip, port);
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    httplib::detail::get_local_ip_and_port(connection_.socket(), ip, port);
  }
  socket_t socket() const override { return connection_.socket(); }
  time_t duration() const override { return 0; }
  void set_read_timeout(time_t seconds, time_t microseconds) override {
    connection_.set_read_timeout(std::chrono::milliseconds(seconds * 1000 + microseconds / 1000));
  }

 private:
  Connection& connection_;
};

class LibrarySocket final : public StreamSocket {
 public:
  LibrarySocket(httplib::ws::WebSocket& socket, Connection& connection)
      : socket_(socket), connection_(connection) {}
  bool read(std::string& text) override { return socket_.read(text) != httplib::ws::Fail; }
  Sent send(const std::string& text) override { return outcome(socket_.send(text)); }
  Sent ping() override { return outcome(connection_.send_control(Connection::Control::ping, "")); }
  // Not the library's close(): that one reads too, while our reader reads.
  void close(int code, const std::string& reason) override {
    const std::string payload{static_cast<char>(code >> 8), static_cast<char>(code & 0xff)};
    connection_.send_control(Connection::Control::close, payload + reason);
  }
  void shut_down() override { connection_.shut_down(); }

 private:
  Sent outcome(bool sent) const {
    return sent ? Sent::yes : connection_.stalled() ? Sent::stalled : Sent::gone;
  }

  httplib::ws::WebSocket& socket_;
  Connection& connection_;
};

/// What a connection's thread knows of its connection while the library runs.
struct ThreadContext {
  Connection* connection = nullptr;
  bool holds_stream_place = false;
};
thread_local ThreadContext this_connection;

/// The library's server on our connections.
class LibraryServer final : public httplib::Server {
 public:
  ConnectionRegistry connections;
  std::atomic<std::size_t> streams{0};

 private:
  bool process_and_close_socket(socket_t socket) override {
    std::string remote;
    std::string local;
    int remote_port = 0;
    int local_port = 0;
    httplib::detail::get_remote_ip_and_port(socket, remote, remote_port);
    httplib::detail::get_local_ip_and_port(socket, local, local_port);
    {
      Connection connection(socket);
      const ConnectionRegistry::Entry entry(connections, connection);
      LibraryStream stream(connection);
      this_connection = {&connection};
      bool upgraded = false;
      for (int left = requests_per_connection; left > 0; --left) {
        if (!connection.wait_for_request(keep_alive_patience)) break;
        bool closed = false;
        if (!process_request(stream, remote, remote_port, local, local_port, left == 1, closed,
                             nullptr, &upgraded) ||
            closed) {
          break;
        }
      }
      if (this_connection.holds_stream_place) --streams;
      this_connection = {};
      if (!upgraded) connection.linger();
    }
    httplib::detail::shutdown_socket(socket);
    httplib::detail::close_socket(socket);
    return true;
  }
};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

HttpRequest from_library(const httplib::Request& request) {
  HttpRequest result;
  result.method = request.method;
  result.path = request.path;
  result.query = {request.params.begin(), request.params.end()};
  for (const auto& [name, value] : request.headers) result.headers.emplace(lower(name), value);
  result.body = request.body;
  return result;
}

void to_library(const HttpResponse& response, httplib::Response& result) {
  result.status = response.status;
  for (const auto& [name, value] : response.headers) result.set_header(name, value);
  result.set_content(response.body, response.content_type);
}

std::string detail_of(int status) {
  if (status == 413) return "the body is over 1 MiB";
  if (status == 414) return "the address is too long";
  if (status == 400) return "the request is not HTTP as this server understands it";
  return "the request cannot be served";
}

}  // namespace

class HttpServer::Impl {
 public:
  Impl(const HttpServerOptions& options, Router router, StreamHandler serve_stream)
      : options_(options), router_(std::move(router)), serve_stream_(std::move(serve_stream)) {
    set_limits();
    set_handlers();
    listen();
    gatekeeper_ = std::make_unique<Gatekeeper>(options_.host, port_);
  }

  int port() const { return port_; }

  void start() {
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    server_.wait_until_ready();
    listening_ = true;
  }

  void stop_listening() {
    // The library may be told so only once.
    if (std::exchange(listening_, false)) server_.stop();
  }

  void stop() {
    stop_listening();
    server_.connections.shut_down_all();
    if (thread_.joinable()) thread_.join();
  }

 private:
  using Handled = httplib::Server::HandlerResponse;

  void set_limits() {
    // Each stream client keeps a thread for as long as it stays. The pool must have them all from
    // the start: one that grows on demand leaves connections waiting behind streams.
    server_.new_task_queue = [threads = request_threads + options_.stream_clients] {
      return new httplib::ThreadPool(threads, 0, max_waiting_connections);
    };
    server_.set_keep_alive_timeout(keep_alive_patience.count());
    server_.set_keep_alive_max_count(requests_per_connection);
    server_.set_tcp_nodelay(true);
    server_.set_payload_max_length(max_body);
    server_.set_websocket_ping_interval(0);  // the writer pings: one thread less for each client
    // The library would share the port with another server that listens there already.
    server_.set_socket_options(
        [](socket_t socket) { httplib::set_socket_opt(socket, SOL_SOCKET, SO_REUSEADDR, 1); });
    // Asked before the body is sent: no need to take it in first.
    server_.set_expect_100_continue_handler([](const auto& request, auto& response) {
      if (request.get_header_value_u64("Content-Length") <= max_body) return 100;
      return response.status = 413;
    });
  }

  void set_handlers() {
    // Runs before anything else, for WebSocket upgrades too.
    server_.set_pre_routing_handler([this](const auto& request, auto& response) {
      return admit(request, response) ? Handled::Unhandled : Handled::Handled;
    });
    const auto route = [this](const httplib::Request& request, httplib::Response& response) {
      to_library(router_.handle(from_library(request)), response);
    };
    server_.Get(".*", route).Post(".*", route).Put(".*", route).Patch(".*", route);
    server_.Delete(".*", httplib::Server::Handler(route)).Options(".*", route);
    server_.WebSocket(options_.stream_path, [this](const auto&, httplib::ws::WebSocket& socket) {
      this_connection.connection->become_websocket();
      LibrarySocket stream(socket, *this_connection.connection);
      serve_stream_(stream);
    });
    server_.set_error_handler([](const httplib::Request&, httplib::Response& response) {
      if (response.body.empty()) {
        to_library(to_response(Problem(response.status, detail_of(response.status))), response);
      }
      return Handled::Handled;
    });
    server_.set_post_routing_handler([](const auto& request, auto& response) {
      for (const auto& [name, value] : security_headers(request.get_header_value("Host"))) {
        response.set_header(name, value);
      }
    });
    server_.set_logger([](const httplib::Request& request, const httplib::Response& response) {
      spdlog::debug("{} {} {}", request.method, request.path, response.status);
    });
  }

  bool admit(const httplib::Request& request, httplib::Response& response) {
    const auto refuse = [&response](const Problem& problem) {
      to_library(to_response(problem), response);
      return false;
    };
    if (request.get_header_value_count("Host") > 1) {
      return refuse(Problem(400, "there is more than one Host"));
    }
    const auto refusal =
        gatekeeper_->refusal(request.get_header_value("Host"), request.get_header_value("Origin"));
    if (refusal) return refuse(Problem(403, *refusal));
    if (request.path != options_.stream_path || !httplib::detail::is_websocket_upgrade(request)) {
      return true;
    }
    if (++server_.streams > options_.stream_clients) {
      --server_.streams;
      return refuse(Problem(503, "there are as many stream clients as this server takes")
                        .with_header("Retry-After", "5"));
    }
    this_connection.holds_stream_place = true;
    return true;
  }

  void listen() {
    port_ = options_.port == 0 ? server_.bind_to_any_port(options_.host)
            : server_.bind_to_port(options_.host, options_.port) ? options_.port
                                                                 : -1;
    if (port_ < 0) {
      throw std::runtime_error("cannot listen on " + options_.host + " port " +
                               std::to_string(options_.port) + "; is it taken?");
    }
  }

  const HttpServerOptions options_;
  const Router router_;
  const StreamHandler serve_stream_;
  LibraryServer server_;
  std::unique_ptr<Gatekeeper> gatekeeper_;
  int port_ = -1;
  bool listening_ = false;
  std::thread thread_;
};

HttpServer::HttpServer(const HttpServerOptions& options, Router router, StreamHandler serve_stream)
    : impl_(std::make_unique<Impl>(options, std::move(router), std::move(serve_stream))) {}

HttpServer::~HttpServer() { stop(); }

int HttpServer::port() const { return impl_->port(); }
void HttpServer::start() { impl_->start(); }
void HttpServer::stop_listening() { impl_->stop_listening(); }
void HttpServer::stop() { impl_->stop(); }

}  // namespace stagger::server
