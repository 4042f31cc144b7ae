#include <pthread.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <csignal>
#include <iostream>
#include <thread>

#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/http/http_server.h"
#include "server/http/routes/routes.h"
#include "server/http/security.h"
#include "server/http/stream.h"

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

// Stream clients get this long to see that the server goes, before they are cut off.
constexpr auto farewell = 600ms;

/// SIGTERM and SIGINT, taken by waiting for them. Made before any thread, so that all inherit the
/// mask and none is interrupted.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGTERM);
    sigaddset(&set_, SIGINT);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  }

  int wait() {
    int signal = 0;
    sigwait(&set_, &signal);
    // The next one ends the process at once.
    ::signal(SIGTERM, SIG_DFL);
    ::signal(SIGINT, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &set_, nullptr);
    return signal;
  }

 private:
  sigset_t set_;
};

void end(HttpServer& server, LiveSession& session, FrameHub& hub) {
  server.stop_listening();
  hub.close_all(1001, "the server stops");
  session.stop();  // whoever waits for a command gets an answer
  const auto latest = std::chrono::steady_clock::now() + farewell;
  while (hub.counters().clients > 0 && std::chrono::steady_clock::now() < latest) {
    std::this_thread::sleep_for(5ms);
  }
  server.stop();
}

std::string in_url(const std::string& host) {
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

}  // namespace

int serve_command(const ServeOptions& options, const Folders& folders) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("stagger"));
  spdlog::set_level(spdlog::level::from_str(options.log_level));
  if (!is_loopback(options.host) && !options.allow_remote) {
    std::cerr << "stagger: --host " << options.host
              << " is not this machine alone. Everyone who reaches it could command the robot: "
                 "this version asks nobody for a key. Add --allow-remote if that is meant.\n";
    return exit_usage;
  }
  StopSignals signals;

  RobotLibrary robots(folders.robots);
  const sim::SimulationConfig config = world_of(options.world, robots);
  if (config.robot == nullptr) return exit_usage;

  FrameHub hub;
  LiveSession session(config, hub, !options.stand);
  Services services{session, hub, robots, folders.web};
  HttpServerOptions http;
  http.host = options.host;
  http.port = options.port;
  http.stream_clients = options.stream_clients;
  std::unique_ptr<HttpServer> server;
  try {
    server = std::make_unique<HttpServer>(
        http, make_router(services), [&hub](StreamSocket& socket) { serve_stream(socket, hub); });
  } catch (const std::runtime_error& error) {
    std::cerr << "stagger: " << error.what() << '\n';
    return exit_transport;
  }
  server->start();
  std::cout << "stagger is serving on http://" << in_url(options.host) << ':' << server->port()
            << std::endl;

  const int signal = signals.wait();
  spdlog::info("{}: stopping", signal == SIGINT ? "SIGINT" : "SIGTERM");
  end(*server, session, hub);
  return exit_ok;
}

}  // namespace stagger::server
