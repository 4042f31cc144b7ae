// What a data message of the stream costs as text and in the two binary forms: a walking robot's
// frames, with all channels. `bytes` is the mean length; the last line says how much cheaper they
// are.
#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

#include "server/json/stream_data.h"
#include "sim/simulation.h"

namespace stagger::server {
namespace {

constexpr std::size_t warm_up_ticks = 2000;
constexpr std::size_t frame_count = 200;
constexpr std::size_t ticks_between = 10;  // 100 Hz

std::vector<FrameMessage> walk() {
  sim::SimulationConfig config;
  config.robot = sim::load_robot("robots/kasaei");
  sim::Simulation simulation(config);
  simulation.walk({});
  auto session = std::make_shared<SessionInfo>();
  session->channels = simulation.channels();
  std::vector<FrameMessage> frames;
  for (std::size_t tick = 0; tick < warm_up_ticks; ++tick) simulation.step();
  for (std::size_t i = 0; i < frame_count; ++i) {
    for (std::size_t tick = 0; tick < ticks_between; ++tick) simulation.step();
    frames.push_back({session, simulation.frame()});
  }
  return frames;
}

const std::vector<FrameMessage>& frames() {
  static const std::vector<FrameMessage> list = walk();
  return list;
}

struct Cost {
  double bytes = 0.0;        ///< a message
  double nanoseconds = 0.0;  ///< of CPU a message
};
std::array<Cost, 3> costs;  // by format

void data_message(benchmark::State& state, StreamFormat format) {
  Subscription all;
  all.format = format;
  const auto subscription = std::make_shared<const Subscription>(all);
  const auto& list = frames();
  DataWriter writer;
  std::size_t bytes = 0;
  std::uint64_t count = 0;
  const std::clock_t start = std::clock();
  for (auto _ : state) {
    const std::string& message = writer.write(list[count % list.size()], subscription, count, 1);
    bytes += message.size();
    ++count;
  }
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const auto messages = static_cast<double>(count);
  Cost& cost = costs[static_cast<std::size_t>(format)];
  // The last and longest run of the benchmark counts.
  cost = {static_cast<double>(bytes) / messages, seconds / messages * 1e9};
  state.counters["bytes"] = cost.bytes;
}
BENCHMARK_CAPTURE(data_message, json, StreamFormat::json);
BENCHMARK_CAPTURE(data_message, float64, StreamFormat::float64);
BENCHMARK_CAPTURE(data_message, float32, StreamFormat::float32);

}  // namespace

void print_ratios() {
  const Cost& json = costs[0];
  const std::array names{"json", "float64", "float32"};
  for (std::size_t i = 1; i < costs.size(); ++i) {
    if (costs[i].bytes == 0.0 || json.bytes == 0.0) continue;
    std::printf("%s beside json: %.1f times fewer bytes, %.1f times less CPU\n", names[i],
                json.bytes / costs[i].bytes, json.nanoseconds / costs[i].nanoseconds);
  }
}

}  // namespace stagger::server

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  stagger::server::print_ratios();
  return 0;
}
