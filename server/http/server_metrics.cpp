#include "server/http/server_metrics.h"

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <time.h>
#include <unistd.h>

#include <fstream>
#include <set>
#include <vector>

#include "server/json/gait_json.h"

namespace stagger::server {
namespace {

using prometheus::MetricFamily;
using prometheus::MetricType;

// From an answer out of memory to a step of many ticks [s].
const prometheus::Histogram::BucketBoundaries durations{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05,
                                                        0.1,   0.25,   0.5,   1.0,  2.5,   10.0};

/// A client may send any word as its method: not one of them makes a new time series.
std::string method_of(const std::string& method) {
  static const std::set<std::string> known{"GET",   "HEAD",   "POST",   "PUT",
                                           "PATCH", "DELETE", "OPTIONS"};
  return known.contains(method) ? method : "other";
}

/// Memory of this process that is in use [bytes].
double resident_bytes() {
  std::ifstream in("/proc/self/statm");
  double pages = 0.0;
  double resident = 0.0;
  in >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Time of the processor that this process has used [s].
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

class Families {
 public:
  void gauge(const std::string& name, const std::string& help, double value) {
    prometheus::ClientMetric metric;
    metric.gauge.value = value;
    list_.push_back({name, help, MetricType::Gauge, {std::move(metric)}});
  }
  void counter(const std::string& name, const std::string& help, double value) {
    prometheus::ClientMetric metric;
    metric.counter.value = value;
    list_.push_back({name, help, MetricType::Counter, {std::move(metric)}});
  }
  void info(const std::string& name, const std::string& help,
            const std::vector<prometheus::ClientMetric::Label>& labels) {
    prometheus::ClientMetric metric;
    metric.gauge.value = 1.0;
    metric.label = labels;
    list_.push_back({name, help, MetricType::Gauge, {std::move(metric)}});
  }
  std::vector<MetricFamily>& list() { return list_; }

 private:
  std::vector<MetricFamily> list_;
};

double number(std::uint64_t value) { return static_cast<double>(value); }

void tell_simulation(Families& out, const LiveSession& session) {
  const SessionState state = session.state();
  const SessionCounters counts = session.counters();
  out.info("stagger_info", "The program, the robot and the plant",
           {{"version", STAGGER_VERSION},
            {"robot", state.robot},
            {"plant", std::string(name_of(state.plant))}});
  out.counter("stagger_ticks_total", "Ticks of 1 ms simulated", number(counts.ticks));
  out.counter("stagger_late_ticks_total", "Ticks that began more than 5 ms late",
              number(state.late_ticks));
  out.gauge("stagger_worst_lateness_seconds", "Of all ticks", 1e-3 * state.worst_lateness_ms);
  out.gauge("stagger_real_time_factor", "Simulated seconds in the last second; 0 while paused",
            state.real_time_factor);
  out.gauge("stagger_running", "0 while paused", state.running ? 1.0 : 0.0);
  out.gauge("stagger_broken", "1 after the simulation broke down, until a reset",
            state.error.empty() ? 0.0 : 1.0);
  out.gauge("stagger_fallen", "1 when the robot has fallen", state.fallen ? 1.0 : 0.0);
  out.counter("stagger_steps_total", "Steps of the robot", number(counts.steps));
  out.counter("stagger_pushes_total", "Pushes that began to act", number(counts.pushes));
  out.counter("stagger_falls_total", "Falls", number(counts.falls));
  out.counter("stagger_sessions_total", "Worlds: one at the start and one for each reset",
              number(counts.sessions));
  out.gauge("stagger_queue_depth", "Commands that wait for the simulation",
            number(counts.waiting_commands));
  out.gauge("stagger_queue_capacity", "Commands that may wait", LiveSession::queue_capacity);
}

void tell_stream(Families& out, const FrameHub& hub) {
  const StreamCounters counts = hub.counters();
  out.gauge("stagger_stream_clients", "Clients of the stream", number(counts.clients));
  out.counter("stagger_stream_dropped_clients_total", "Clients cut off for taking nothing",
              number(counts.dropped_clients));
  out.counter("stagger_stream_dropped_messages_total", "Messages left out for slow clients",
              number(counts.dropped_messages));
}

void tell_process(Families& out) {
  out.gauge("process_resident_memory_bytes", "Resident memory", resident_bytes());
  out.counter("process_cpu_seconds_total", "Time of the processor", processor_seconds());
}

}  // namespace

class ServerMetrics::Impl {
 public:
  Impl(const LiveSession& session, const FrameHub& hub) : session_(session), hub_(hub) {}

  void count(const RequestSummary& request) {
    const std::string method = method_of(request.method);
    const std::string route = request.route.empty() ? "other" : request.route;
    requests_
        .Add({{"method", method}, {"route", route}, {"status", std::to_string(request.status)}})
        .Increment();
    seconds_.Add({{"method", method}, {"route", route}}, durations).Observe(request.seconds);
  }

  std::string text() const {
    Families families;
    tell_simulation(families, session_);
    tell_stream(families, hub_);
    tell_process(families);
    for (MetricFamily& family : registry_.Collect()) families.list().push_back(std::move(family));
    return prometheus::TextSerializer().Serialize(families.list());
  }

 private:
  const LiveSession& session_;
  const FrameHub& hub_;
  prometheus::Registry registry_;
  prometheus::Family<prometheus::Counter>& requests_ = prometheus::BuildCounter()
                                                           .Name("stagger_http_requests_total")
                                                           .Help("Requests answered")
                                                           .Register(registry_);
  prometheus::Family<prometheus::Histogram>& seconds_ =
      prometheus::BuildHistogram()
          .Name("stagger_http_request_duration_seconds")
          .Help("From a request's arrival to its answer, the body's arrival included")
          .Register(registry_);
};

ServerMetrics::ServerMetrics(const LiveSession& session, const FrameHub& hub)
    : impl_(std::make_unique<Impl>(session, hub)) {}
ServerMetrics::~ServerMetrics() = default;

void ServerMetrics::count(const RequestSummary& request) { impl_->count(request); }
std::string ServerMetrics::text() const { return impl_->text(); }

}  // namespace stagger::server
