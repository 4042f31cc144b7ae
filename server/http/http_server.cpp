#include "server/http/http_server.h"

// Settings of the library; nobody else includes it, so that they hold everywhere.
#define CPPHTTPLIB_LISTEN_BACKLOG 1024
// A dead client is noticed when it has answered no ping for this long.
#define CPPHTTPLIB_WEBSOCKET_READ_TIMEOUT_SECOND 10
// Above the 64 KiB that the stream takes: a message that is too long can still be answered.
#define CPPHTTPLIB_WEBSOCKET_MAX_PAYLOAD_LENGTH (1024 * 1024)
#include <httplib.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "server/http/connection.h"
#include "server/http/problem.h"
#include "server/http/rate_limiter.h"
#include "server/http/reception.h"
#include "server/http/worker_pool.h"

namespace stagger::server {
namespace {

constexpr std::size_t max_body = 1 << 20;
constexpr std::size_t max_upload = 32 << 20;
constexpr int max_uploads = 2;  // at a time: they are held in memory
constexpr std::size_t max_form_parts = 256;
constexpr std::size_t request_threads = 64;
// Of their own for bodies that are still on their way: whoever sends one slowly keeps nobody
// waiting who sends a whole request.
constexpr std::size_t body_threads = 16;
constexpr std::size_t max_waiting_requests = 256;
// For those who send several requests at once on one connection.
constexpr std::size_t threads_for_more = 2;
// Commands may wait long for the simulation; whoever only asks must still find a thread.
constexpr std::size_t max_commands_at_once = request_threads / 2;
constexpr std::size_t max_idle_connections = 2048;
constexpr int requests_per_connection = 1000;
constexpr std::size_t sent_at_once = 1 << 16;  // of a file
// Told to clients: less than the reception's patience, so that they let go first.
constexpr std::chrono::seconds keep_alive{5};
// Whoever keeps a request going for longer, while we wait for the client, makes room for others
// when threads run out.
constexpr std::chrono::milliseconds slow_request{500};
// A wrong key costs as many commands, so that keys cannot be tried in bulk.
constexpr double wrong_key_cost = 50.0;
constexpr std::string_view too_busy =
    "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 1\r\nConnection: close\r\n"
    "Content-Length: 0\r\n\r\n";

/// As many descriptors as the system lets us have: one for each client.
std::size_t raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return max_idle_connections;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 65536);
  setrlimit(RLIMIT_NOFILE, &limit);
  getrlimit(RLIMIT_NOFILE, &limit);
  return limit.rlim_cur;
}

/// Connections that may be idle, so that descriptors are left for the others and for files.
std::size_t reception_room(std::size_t stream_clients) {
  const std::size_t others =
      stream_clients + request_threads + body_threads + 2 * max_waiting_requests + 128;
  const std::size_t descriptors = raise_descriptor_limit();
  const std::size_t left = descriptors > others ? descriptors - others : 0;
  return std::clamp<std::size_t>(left, 64, max_idle_connections);
}

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
  Sent send_binary(const std::string& bytes) override {
    return outcome(socket_.send(bytes.data(), bytes.size()));
  }
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
  bool has_failed = false;  ///< an error was answered, which the library calls the last answer
  std::chrono::steady_clock::time_point start = {};  ///< of the request
  std::string route = {};
};
thread_local ThreadContext this_connection;

/// The library hands out every connection that it accepts; we keep the threads ourselves.
class AtOnce final : public httplib::TaskQueue {
 public:
  bool enqueue(std::function<void()> task) override {
    task();
    return true;
  }
  void shutdown() override {}
};

/// The library's server on our connections: they wait in the reception until a request has come,
/// and only then is there a thread for them.
class LibraryServer final : public httplib::Server {
 public:
  explicit LibraryServer(std::size_t stream_clients)
      : whole_(request_threads + stream_clients, *this),
        begun_(body_threads, *this),
        reception_(
            reception_room(stream_clients),
            [this](const ConnectionPtr& connection, Connection::Request request) {
              hand_over(connection, request);
            },
            [this] {
              whole_.make_room();
              begun_.make_room();
            }) {
    new_task_queue = [] { return new AtOnce; };
  }

  ~LibraryServer() override { end(); }

  /// Ends all connections and returns when all threads have ended. May be called again.
  void end() {
    reception_.stop();
    whole_.connections.shut_down_all();
    begun_.connections.shut_down_all();
    whole_.pool.stop();
    begun_.pool.stop();
  }

  std::atomic<std::size_t> streams{0};
  std::atomic<int> uploads{0};

 private:
  using ConnectionPtr = Reception::ConnectionPtr;

  // In the thread that accepts.
  bool process_and_close_socket(socket_t socket) override {
    reception_.await_request(ConnectionPtr(new Connection(socket), [](Connection* connection) {
      httplib::detail::shutdown_socket(connection->socket());
      httplib::detail::close_socket(connection->socket());
      delete connection;
    }));
    return true;
  }

  /// Threads and those whom they serve.
  struct Desk {
    Desk(std::size_t threads, LibraryServer& server)
        : pool({threads, threads_for_more, max_waiting_requests},
               [this, &server](const ConnectionPtr& connection) {
                 server.serve(connection, connections);
               }) {}

    // In the reception's thread.
    void make_room() {
      const std::size_t waiting = pool.waiting();
      if (waiting == 0) return;
      const auto since = std::chrono::steady_clock::now() - slow_request;
      const std::size_t cut = connections.cut_slowest(waiting, since);
      if (cut > 0) spdlog::warn("cut off {} slow clients, others wait for their threads", cut);
    }

    ConnectionRegistry connections;
    WorkerPool<ConnectionPtr> pool;
  };

  Desk& desk_for(Connection::Request request) {
    return request == Connection::Request::whole ? whole_ : begun_;
  }

  // In the reception's thread.
  void hand_over(const ConnectionPtr& connection, Connection::Request request) {
    if (const auto left_out = desk_for(request).pool.add(connection)) {
      (*left_out)->try_write(too_busy);
    }
  }

  enum class Next : std::uint8_t { await_request, drain, close };

  void serve(const ConnectionPtr& connection, ConnectionRegistry& connections) {
    Next next = Next::close;
    {
      const ConnectionRegistry::Entry entry(connections, *connection);
      this_connection = {connection.get()};
      next = serve_request(*connection);
      if (this_connection.holds_stream_place) --streams;
      this_connection = {};
    }
    if (next == Next::await_request) {
      await_request(connection);
    } else if (next == Next::drain) {
      connection->end_writing();
      reception_.drain(connection);
    }
  }

  /// The next one. Whoever has sent it already lets others go first.
  void await_request(const ConnectionPtr& connection) {
    const Connection::Request request = connection->take_in();
    if (request == Connection::Request::incomplete) {
      reception_.await_request(connection);
    } else if (request != Connection::Request::gone) {
      if (desk_for(request).pool.add_more(connection)) connection->try_write(too_busy);
    }
  }

  /// One that has come, at least its head.
  Next serve_request(Connection& connection) {
    std::string remote;
    std::string local;
    int remote_port = 0;
    int local_port = 0;
    httplib::detail::get_remote_ip_and_port(connection.socket(), remote, remote_port);
    httplib::detail::get_local_ip_and_port(connection.socket(), local, local_port);
    LibraryStream stream(connection);
    connection.begin_request();
    const bool last = connection.count_request() >= requests_per_connection;
    bool closed = false;
    bool upgraded = false;
    const bool served = process_request(stream, remote, remote_port, local, local_port, last,
                                        closed, nullptr, &upgraded);
    if (upgraded) return Next::close;
    if (!served || closed || last || this_connection.has_failed) return Next::drain;
    return Next::await_request;
  }

  Desk whole_;
  Desk begun_;
  Reception reception_;
};

HttpRequest from_library(const httplib::Request& request) {
  HttpRequest result;
  result.method = request.method;
  result.path = request.path;
  result.query = {request.params.begin(), request.params.end()};
  for (const auto& [name, value] : request.headers) result.headers.emplace(lower(name), value);
  return result;
}

/// The file stays open: it may be deleted while it is sent.
void send_file(const HttpResponse& response, httplib::Response& result) {
  const auto file = std::make_shared<std::ifstream>(response.file, std::ios::binary);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(response.file, error);
  if (error || !*file) throw Problem(404, "the file cannot be read");
  result.set_content_provider(
      size, response.content_type,
      [file](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        std::string part(std::min(length, sent_at_once), '\0');
        file->clear();
        file->seekg(static_cast<std::streamoff>(offset));
        if (!file->read(part.data(), static_cast<std::streamsize>(part.size()))) return false;
        return sink.write(part.data(), part.size());
      });
}

void send_source(const HttpResponse& response, httplib::Response& result) {
  result.set_chunked_content_provider(
      response.content_type, [source = response.source](std::size_t, httplib::DataSink& sink) {
        std::string part;
        bool more = false;
        try {
          more = source(part);
        } catch (const std::exception& error) {
          spdlog::error("an answer ends too early: {}", error.what());
          return false;
        }
        if (!part.empty() && !sink.write(part.data(), part.size())) return false;
        if (!more) sink.done();
        return true;
      });
}

void to_library(const HttpResponse& response, httplib::Response& result) {
  result.status = response.status;
  for (const auto& [name, value] : response.headers) result.set_header(name, value);
  if (!response.file.empty()) {
    send_file(response, result);
  } else if (response.source) {
    send_source(response, result);
  } else {
    result.set_content(response.body, response.content_type);
  }
}

/// Takes a body piece by piece, as text or as the parts of a form, up to a size.
class BodyReader {
 public:
  explicit BodyReader(std::size_t most) : left_(most) {}

  /// False when the body could not be read, or is too long.
  bool read(const httplib::Request& from, const httplib::ContentReader& reader, HttpRequest& to) {
    if (!from.is_multipart_form_data()) {
      return reader([&](const char* data, std::size_t size) { return take(to.body, data, size); });
    }
    return reader(
        [&](const httplib::FormData& part) {
          if (to.form.size() >= max_form_parts) return !(too_long_ = true);
          to.form.push_back({part.name, part.filename, ""});
          return true;
        },
        [&](const char* data, std::size_t size) {
          return !to.form.empty() && take(to.form.back().content, data, size);
        });
  }
  bool too_long() const { return too_long_; }

 private:
  bool take(std::string& text, const char* data, std::size_t size) {
    if (size > left_) return !(too_long_ = true);
    left_ -= size;
    text.append(data, size);
    return true;
  }

  std::size_t left_;
  bool too_long_ = false;
};

std::string detail_of(int status) {
  if (status == 413) return "the body is over 1 MiB (32 MiB for the upload of a robot)";
  if (status == 414) return "the address is too long";
  if (status == 400) return "the request is not HTTP as this server understands it";
  return "the request cannot be served";
}

}  // namespace

class HttpServer::Impl {
 public:
  Impl(const HttpServerOptions& options, Access& access, Router router, StreamHandler serve_stream,
       Counter count)
      : options_(options),
        access_(access),
        router_(std::move(router)),
        serve_stream_(std::move(serve_stream)),
        count_(std::move(count)),
        limiter_(options.command_rate, 2.0 * options.command_rate),
        server_(options.stream_clients) {
    for (const std::string& route : router_.table()) spdlog::debug("route {}", route);
    set_limits();
    set_handlers();
    listen();
    gatekeeper_ = std::make_unique<Gatekeeper>(options_.host, port_, options_.allowed);
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
    if (thread_.joinable()) thread_.join();
    server_.end();
  }

 private:
  using Handled = httplib::Server::HandlerResponse;

  void set_limits() {
    server_.set_keep_alive_timeout(keep_alive.count());
    server_.set_keep_alive_max_count(requests_per_connection);
    server_.set_tcp_nodelay(true);
    server_.set_payload_max_length(max_upload);  // the rest is up to read_body()
    server_.set_websocket_ping_interval(0);  // the writer pings: one thread less for each client
    // The library would share the port with another server that listens there already.
    server_.set_socket_options(
        [](socket_t socket) { httplib::set_socket_opt(socket, SOL_SOCKET, SO_REUSEADDR, 1); });
    // Asked before the body is sent: no need to take it in first.
    server_.set_expect_100_continue_handler([this](const auto& request, auto& response) {
      if (request.get_header_value_u64("Content-Length") <= body_limit(request)) return 100;
      return response.status = 413;
    });
  }

  void set_handlers() {
    // Runs before anything else, for WebSocket upgrades too.
    server_.set_pre_routing_handler([this](const auto& request, auto& response) {
      this_connection.start = std::chrono::steady_clock::now();
      this_connection.route.clear();
      return admit(request, response) ? Handled::Unhandled : Handled::Handled;
    });
    const auto route = [this](const httplib::Request& request, httplib::Response& response) {
      answer(from_library(request), response);
    };
    const auto route_body = [this](const httplib::Request& request, httplib::Response& response,
                                   const httplib::ContentReader& reader) {
      handle_body(request, response, reader);
    };
    server_.Get(".*", route).Options(".*", route);
    server_.Post(".*", route_body).Put(".*", route_body).Patch(".*", route_body);
    server_.Delete(".*", httplib::Server::Handler(route));
    server_.Delete(".*", httplib::Server::HandlerWithContentReader(route_body));
    server_.WebSocket(options_.stream_path, [this](const auto&, httplib::ws::WebSocket& socket) {
      this_connection.connection->become_websocket();
      LibrarySocket stream(socket, *this_connection.connection);
      serve_stream_(stream);
    });
    server_.set_error_handler([](const httplib::Request&, httplib::Response& response) {
      this_connection.has_failed = true;
      if (response.body.empty()) {
        to_library(to_response(Problem(response.status, detail_of(response.status))), response);
      }
      return Handled::Handled;
    });
    server_.set_post_routing_handler([this](const auto& request, auto& response) {
      const auto set = [&response](const Headers& headers) {
        for (const auto& [name, value] : headers) response.set_header(name, value);
      };
      const std::string origin = request.get_header_value("Origin");
      set(security_headers(shown_host(request.get_header_value("Host"))));
      if (gatekeeper_->is_allowed_origin(origin)) set(cross_origin_headers(origin));
    });
    server_.set_exception_handler([](const auto& request, auto& response, const auto&) {
      spdlog::error("{} {}: an exception", request.method, request.path);
      to_library(to_response(Problem(500, "an unexpected error")), response);
    });
    server_.set_logger([this](const httplib::Request& request, const httplib::Response& response) {
      spdlog::debug("{} {} {}", request.method, request.path, response.status);
      if (!count_) return;
      const std::chrono::duration<double> time =
          std::chrono::steady_clock::now() - this_connection.start;
      count_({request.method, this_connection.route, response.status, time.count()});
    });
  }

  std::size_t body_limit(const httplib::Request& request) const {
    return request.method == "POST" && request.path == options_.upload_path ? max_upload : max_body;
  }

  void answer(HttpRequest request, httplib::Response& response) {
    try {
      const HttpResponse answer = handle(std::move(request));
      this_connection.route = answer.route;
      to_library(answer, response);
    } catch (const Problem& problem) {
      to_library(to_response(problem), response);
    }
  }

  void handle_body(const httplib::Request& request, httplib::Response& response,
                   const httplib::ContentReader& reader) {
    const bool upload = body_limit(request) == max_upload;
    const auto place = upload ? upload_place() : nullptr;
    const auto refuse = [&response](const Problem& problem) {
      to_library(to_response(problem), response);
    };
    if (upload && place == nullptr) {
      return refuse(Problem(503, "other uploads are under way").with_header("Retry-After", "5"));
    }
    HttpRequest whole = from_library(request);
    BodyReader body(body_limit(request));
    if (body.read(request, reader, whole)) return answer(std::move(whole), response);
    const int status = body.too_long() || response.status == 413 ? 413 : 400;
    refuse(Problem(status, detail_of(status)));
  }

  /// Held while an upload is in memory; nothing when there are enough of them.
  std::shared_ptr<void> upload_place() {
    auto& uploads = server_.uploads;
    if (++uploads > max_uploads) {
      --uploads;
      return nullptr;
    }
    return {&uploads, [](std::atomic<int>* count) { --*count; }};
  }

  bool admit(const httplib::Request& request, httplib::Response& response) {
    const auto refuse = [&response](const Problem& problem) {
      to_library(to_response(problem), response);
      return false;
    };
    for (const char* once : {"Host", "Origin", "Authorization", "X-Api-Key"}) {
      if (request.get_header_value_count(once) > 1) {
        return refuse(Problem(400, std::string("there is more than one ") + once));
      }
    }
    const std::string origin = request.get_header_value("Origin");
    const auto refusal = gatekeeper_->refusal(request.get_header_value("Host"), origin);
    if (refusal) return refuse(Problem(403, *refusal));
    // These bodies are for nobody, and the library takes them as a whole.
    if (!is_command(request.method) &&
        (request.has_header("Transfer-Encoding") ||
         request.get_header_value_u64("Content-Length") > max_body)) {
      return refuse(Problem(413, detail_of(413)));
    }
    if (is_preflight(request) && gatekeeper_->is_allowed_origin(origin)) {
      to_library({204, "", "", preflight_headers()}, response);
      return false;
    }
    const bool is_stream =
        request.path == options_.stream_path && httplib::detail::is_websocket_upgrade(request);
    if (const auto problem = check_rate_and_key(request, is_stream)) return refuse(*problem);
    if (!is_stream) return true;
    if (++server_.streams > options_.stream_clients) {
      --server_.streams;
      return refuse(Problem(503, "there are as many stream clients as this server takes")
                        .with_header("Retry-After", "5"));
    }
    this_connection.holds_stream_place = true;
    return true;
  }

  static bool is_preflight(const httplib::Request& request) {
    return request.method == "OPTIONS" && request.has_header("Access-Control-Request-Method");
  }

  std::optional<Problem> check_rate_and_key(const httplib::Request& request, bool is_stream) {
    const auto now = std::chrono::steady_clock::now();
    const auto slow_down = [](long seconds) {
      return Problem(429, "this address sends too much; wait " + std::to_string(seconds) + " s")
          .with_header("Retry-After", std::to_string(seconds));
    };
    if (is_command(request.method)) {
      if (const auto wait = limiter_.take(request.remote_addr, now)) return slow_down(*wait);
    }
    // A browser's WebSocket cannot send a header: it brings a ticket in its address.
    if (is_stream && access_.asks_for_a_key() && request.has_param("ticket") &&
        access_.redeem(request.get_param_value("ticket"), now)) {
      return std::nullopt;
    }
    HttpRequest asked;
    asked.method = request.method;
    asked.path = request.path;
    for (const char* name : {"Authorization", "X-Api-Key"}) {
      asked.headers.emplace(lower(name), request.get_header_value(name));
    }
    auto problem = access_.refusal(asked);
    if (problem && problem->status == 401) {
      if (const auto wait = limiter_.take(request.remote_addr, now, wrong_key_cost)) {
        return slow_down(*wait);
      }
    }
    return problem;
  }

  static bool is_command(const std::string& method) {
    return method != "GET" && method != "HEAD" && method != "OPTIONS";
  }

  /// Only what has been let in is repeated in a header.
  std::string shown_host(const std::string& host) const {
    return gatekeeper_->refusal(host, "") ? "localhost" : host;
  }

  HttpResponse handle(HttpRequest request) {
    if (!is_command(request.method)) return router_.handle(std::move(request));
    struct Place {
      explicit Place(std::atomic<std::size_t>& taken) : count(taken), number(++taken) {}
      ~Place() { --count; }
      Place(const Place&) = delete;
      Place& operator=(const Place&) = delete;
      std::atomic<std::size_t>& count;
      std::size_t number;
    } const place(commands_);
    if (place.number <= max_commands_at_once) return router_.handle(std::move(request));
    return to_response(
        Problem(503, "too many commands are under way").with_header("Retry-After", "1"));
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
  Access& access_;
  const Router router_;
  const StreamHandler serve_stream_;
  const Counter count_;
  RateLimiter limiter_;
  std::atomic<std::size_t> commands_{0};
  LibraryServer server_;
  std::unique_ptr<Gatekeeper> gatekeeper_;
  int port_ = -1;
  bool listening_ = false;
  std::thread thread_;
};

HttpServer::HttpServer(const HttpServerOptions& options, Access& access, Router router,
                       StreamHandler serve_stream, Counter count)
    : impl_(std::make_unique<Impl>(options, access, std::move(router), std::move(serve_stream),
                                   std::move(count))) {}

HttpServer::~HttpServer() { stop(); }

int HttpServer::port() const { return impl_->port(); }
void HttpServer::start() { impl_->start(); }
void HttpServer::stop_listening() { impl_->stop_listening(); }
void HttpServer::stop() { impl_->stop(); }

}  // namespace stagger::server
