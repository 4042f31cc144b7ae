#include <malloc.h>
#include <pthread.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <csignal>
#include <iostream>
#include <thread>

#include "server/cli/api_keys.h"
#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/http/http_server.h"
#include "server/http/routes/routes.h"
#include "server/http/security.h"
#include "server/http/server_metrics.h"
#include "server/http/stream.h"
#include "server/json/campaign_json.h"
#include "server/presence.h"
#include "server/presets/preset_store.h"
#include "server/robot_uploads.h"

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

// Stream clients get this long to see that the server goes, before they are cut off.
constexpr auto farewell = 600ms;
// A campaign's trials get this long to end; those that do not are run again by its resume.
constexpr auto trial_patience = 4s;
constexpr double bytes_per_gb = 1e9;
// Pieces of memory from this size on are given back to the system one by one. Left to itself the
// C library keeps ever larger ones, and the holes between the chunks of the flight recorder add up.
constexpr int own_pages_bytes = 128 << 10;

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

void end(HttpServer& server, LiveSession& session, FrameHub& hub, Recorder& recorder) {
  server.stop_listening();
  hub.close_all(1001, "the server stops");
  session.stop();  // whoever waits for a command gets an answer
  recorder.finish();
  const auto latest = std::chrono::steady_clock::now() + farewell;
  while (hub.counters().clients > 0 && std::chrono::steady_clock::now() < latest) {
    std::this_thread::sleep_for(5ms);
  }
  server.stop();
}

/// Tells whoever listens how far a campaign is.
void announce(const campaign::QueueItem& item, FrameHub& hub) {
  const FramePtr latest = hub.latest();
  hub.announce(
      campaign_event(item, latest ? latest->frame.tick : 0, latest ? latest->frame.time : 0.0));
}

std::string in_url(const std::string& host) {
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

}  // namespace

int serve_command(const ServeOptions& options, const Folders& folders) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("stagger"));
  spdlog::set_level(spdlog::level::from_str(options.log_level));
  const auto keys = read_api_keys(options.api_key_file, options.read_only_key_file);
  if (!keys) return exit_usage;
  if (!is_loopback(options.host) && keys->full.empty()) {
    std::cerr << "stagger: --host " << options.host
              << " is not this machine alone, and everyone who reaches it could command the "
                 "robot: give a key with --api-key-file or STAGGER_API_KEY\n";
    return exit_usage;
  }
  mallopt(M_MMAP_THRESHOLD, own_pages_bytes);
  StopSignals signals;

  RobotLibrary robots(folders.robots, folders.uploaded_robots());
  const sim::SimulationConfig config = world_of(options.world, robots);
  if (config.robot == nullptr) return exit_usage;
  if (options.check_config) {
    std::cout << options.settings.dump(2) << std::endl;
    return exit_ok;
  }

  FrameHub hub;
  Access access(*keys);
  const Presence presence(folders.data);
  Recorder recorder({folders.data, static_cast<std::uint64_t>(options.quota_gb * bytes_per_gb)},
                    presence);
  hub.set_listener(recorder);
  LiveSession session(config, hub, !options.stand);
  PresetStore presets(folders.data / "presets");
  RobotUploads uploads(robots, folders.data, folders.executable);
  ServerMetrics metrics(session, hub);
  campaign::CampaignQueue campaigns(
      folders.data / "campaigns", robots, presence,
      [&hub](const campaign::QueueItem& item) { announce(item, hub); });
  Services services{session, hub,         robots,  access,   uploads,
                    metrics, folders.web, presets, recorder, campaigns};
  HttpServerOptions http;
  http.host = options.host;
  http.port = options.port;
  http.stream_clients = options.stream_clients;
  http.command_rate = options.command_rate;
  http.allowed = {options.allow_hosts, options.allow_origins};
  std::unique_ptr<HttpServer> server;
  try {
    server = std::make_unique<HttpServer>(
        http, access, make_router(services),
        [&hub](StreamSocket& socket) { serve_stream(socket, hub); },
        [&metrics](const RequestSummary& request) { metrics.count(request); });
  } catch (const std::runtime_error& error) {
    std::cerr << "stagger: " << error.what() << '\n';
    return exit_transport;
  }
  server->start();
  std::cout << "stagger is serving on http://" << in_url(options.host) << ':' << server->port()
            << std::endl;

  const int signal = signals.wait();
  spdlog::info("{}: stopping", signal == SIGINT ? "SIGINT" : "SIGTERM");
  uploads.stop();
  campaigns.stop(0s);
  end(*server, session, hub, recorder);
  if (!campaigns.stop(trial_patience)) {
    spdlog::info("trials of a campaign are given up; its resume runs them again");
    spdlog::shutdown();
    std::cout.flush();
    std::_Exit(exit_ok);  // nobody waits for a trial that may take long
  }
  return exit_ok;
}

}  // namespace stagger::server
