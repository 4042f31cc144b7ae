#include "server/live/live_session.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <random>

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

// Between two slices of a long step the other commands get their turn.
constexpr auto step_slice = 5ms;
// How long ticks that need not keep to the clock wait for whoever records them. Commands wait with
// them: a disk that hangs must not hold these up for much longer than people notice.
constexpr auto room_patience = 1s;
constexpr int simulation_nice = -11;

std::string random_id() {
  std::random_device device;
  const std::uint64_t high = device();
  return sim::to_hex((high << 32) ^ device());
}

// An absolute time, so that the time which a tick takes does not add up.
void sleep_until(std::chrono::steady_clock::time_point when) {
  const auto since = when.time_since_epoch();
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(since);
  timespec due{};
  due.tv_sec = seconds.count();
  due.tv_nsec = std::chrono::duration_cast<std::chrono::nanoseconds>(since - seconds).count();
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
  }
}

std::string_view kind_of(sim::EventKind kind) {
  switch (kind) {
    case sim::EventKind::step:
      return "step";
    case sim::EventKind::adjustment:
      return "adjustment";
    case sim::EventKind::strategies:
      return "strategies";
    case sim::EventKind::parameters:
      return "parameters";
    case sim::EventKind::push_started:
      return "push_started";
    case sim::EventKind::push_done:
      return "push_done";
    case sim::EventKind::push_cancelled:
      return "push_cancelled";
    case sim::EventKind::fall:
      return "fall";
  }
  return "step";
}

}  // namespace

LiveSession::LiveSession(const sim::SimulationConfig& config, FrameHub& hub, bool walk_at_start)
    : hub_(hub),
      world_(std::make_unique<sim::Simulation>(config)),
      pacer_(std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(sim::Simulation::tick_s))) {
  start_session();
  if (walk_at_start) apply(sim::Walk{walk_});
  show_state();
  thread_ = std::thread([this] { run(); });
}

LiveSession::~LiveSession() { stop(); }

void LiveSession::stop() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
}

SessionState LiveSession::state() const {
  const std::lock_guard lock(state_mutex_);
  return state_;
}

// A compiler that runs beside us makes ticks late by a whole time slice. Only some users may raise
// the priority; without it the simulation runs as well as it can.
void LiveSession::set_priority(bool high) const {
  const int nice = high ? simulation_nice : normal_nice_;
  if (setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice) != 0) {
    spdlog::debug("the simulation thread keeps its priority");
  }
}

SessionCounters LiveSession::counters() const {
  return {counts_.ticks, counts_.steps,    counts_.pushes,
          counts_.falls, counts_.sessions, queue_.size()};
}

void LiveSession::run() {
  normal_nice_ = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
  set_priority(true);
  pacer_.restart(Clock::now());
  while (!queue_.closed()) {
    if (running_) {
      wait_for_tick();
    } else if (steps_.empty()) {
      queue_.wait(100ms);
    }
    // Whatever goes wrong in a world must not take the server down with it.
    try {
      for (const Command& command : queue_.take()) command.run();
      if (running_) {
        if (Clock::now() >= pacer_.due()) run_tick();
      } else if (!steps_.empty()) {
        run_steps();
      }
    } catch (const std::exception& error) {
      break_down(error.what());
    } catch (...) {
      break_down("an unknown error");
    }
  }
  const CommandError stopping(CommandError::Kind::stopping, "the server is stopping");
  end_steps(stopping);
  for (const Command& command : queue_.take()) command.refuse(stopping);
}

void LiveSession::wait_for_tick() {
  // At a slow pace a command is not to wait for the tick.
  constexpr auto nap = 2ms;
  while (pacer_.due() - Clock::now() > nap) {
    const auto left = std::chrono::floor<std::chrono::milliseconds>(pacer_.due() - Clock::now());
    if (queue_.wait(left - 1ms)) return;
  }
  sleep_until(pacer_.due());
}

void LiveSession::run_tick() {
  // Faster than the clock, a recorder that falls behind would lose ticks.
  if (pacer_.speed().value_or(2.0) > 1.0) hub_.await_room(room_patience);
  pacer_.tick(Clock::now());
  advance();
  hub_.publish(frame_, false);
  try_show_state();
}

void LiveSession::run_steps() {
  hub_.await_room(room_patience);
  const auto end = Clock::now() + step_slice;
  StepJob& job = steps_.front();
  do {
    advance();
    --job.ticks_left;
    hub_.publish(frame_, job.ticks_left == 0);
  } while (job.ticks_left > 0 && Clock::now() < end);
  show_state();
  if (job.ticks_left > 0) return;
  job.ticket->answer(now());
  steps_.pop_front();
}

void LiveSession::advance() {
  world_->step();
  ++counts_.ticks;
  make_frame();
  hub_.record(frame_);
  for (sim::Event& event : world_->take_events()) {
    count(event.kind);
    auto message = std::make_shared<EventMessage>();
    message->tick = event.tick;
    message->time = event.time;
    message->kind = kind_of(event.kind);
    message->text = std::move(event.text);
    message->values = std::move(event.values);
    if (event.kind == sim::EventKind::parameters) {
      active_parameters_ =
          std::make_shared<const sim::ParameterValues>(world_->active_parameters());
    }
    publish(std::move(message));
  }
}

void LiveSession::count(sim::EventKind kind) {
  if (kind == sim::EventKind::step) ++counts_.steps;
  if (kind == sim::EventKind::push_started) ++counts_.pushes;
  if (kind == sim::EventKind::fall) ++counts_.falls;
}

void LiveSession::publish(const EventPtr& event) {
  events_.add(event);
  hub_.publish(event);
}

void LiveSession::make_frame() {
  auto message = std::make_shared<FrameMessage>();
  message->session = session_;
  message->frame = world_->frame();
  message->state_hash = world_->state_hash();
  frame_ = std::move(message);
}

void LiveSession::repeat_frame() { hub_.publish(frame_, true); }

void LiveSession::start_session() {
  const sim::SimulationConfig& config = world_->config();
  auto session = std::make_shared<SessionInfo>();
  session->id = random_id();
  session->robot = config.robot->name;
  session->plant = config.plant;
  session->seed = config.seed;
  session->terrain = config.terrain;
  session->channels = world_->channels();
  session->config = config;
  session->journal = std::make_shared<Journal>();
  session_ = std::move(session);
  ++counts_.sessions;
  strategies_ = config.strategies;
  parameters_ = std::make_shared<const sim::ParameterValues>(config.parameters);
  active_parameters_ = parameters_;
  events_.clear();
  hub_.start_session(session_);
  make_frame();
  hub_.publish(frame_, true);
}

void LiveSession::break_down(const std::string& why) {
  spdlog::error("the simulation broke down at tick {}: {}", world_->next_tick(), why);
  running_ = false;
  error_ = why;
  hub_.set_running(false);
  end_steps({CommandError::Kind::conflict, "the simulation broke down: " + why});
  announce(now(), "breakdown: " + why, "server");
  repeat_frame();
  show_state();
}

void LiveSession::end_steps(const CommandError& why) {
  for (const StepJob& job : steps_) job.ticket->fail(why);
  steps_.clear();
}

void LiveSession::apply(const sim::WorldCommand& command) {
  sim::apply(*world_, command);
  session_->journal->add(world_->next_tick(), command);
}

void LiveSession::require_intact() const {
  if (!error_.empty()) {
    throw CommandError(CommandError::Kind::conflict,
                       "the simulation broke down and takes a reset: " + error_);
  }
}

void LiveSession::require_room_for_a_push() {
  const auto& pushes = world_->pushes();
  std::erase_if(open_pushes_, [&pushes](std::uint64_t id) {
    const sim::PushState state = pushes[id - 1].state;
    return state == sim::PushState::done || state == sim::PushState::cancelled;
  });
  if (open_pushes_.size() >= max_open_pushes) {
    throw CommandError(CommandError::Kind::conflict, "too many pushes wait; cancel some");
  }
  if (pushes.size() >= max_pushes) {
    throw CommandError(CommandError::Kind::conflict, "too many pushes in one session; reset it");
  }
}

Effect LiveSession::now() const {
  const std::uint64_t tick = world_->next_tick();
  return {tick, static_cast<double>(tick) * sim::Simulation::tick_s};
}

void LiveSession::announce(const Effect& effect, std::string text, const std::string& source,
                           std::vector<std::pair<std::string, double>> values) {
  spdlog::debug("{} at tick {} ({})", text, effect.tick, source);
  auto message = std::make_shared<EventMessage>();
  message->tick = effect.tick;
  message->time = effect.time_s;
  message->kind = "command";
  message->text = std::move(text);
  message->values = std::move(values);
  message->source = source;
  publish(std::move(message));
}

SessionState LiveSession::describe() const {
  const sim::Frame& frame = world_->frame();
  SessionState state;
  state.session_id = session_->id;
  state.robot = session_->robot;
  state.plant = session_->plant;
  state.seed = session_->seed;
  state.terrain = session_->terrain;
  state.tick = now().tick;
  state.time_s = now().time_s;
  state.running = running_;
  state.walking_state = frame.state;
  state.fallen = frame.fallen;
  state.fall_reason = world_->fall_reason();
  state.strategies = strategies_;
  state.senses = world_->config().senses;
  state.walk = walk_;
  state.step_count = frame.step_count;
  state.worst_dcm_error_m = world_->worst_dcm_error();
  state.speed = pacer_.speed();
  state.parameters = parameters_;
  state.active_parameters = active_parameters_;
  state.real_time_factor = running_ ? pacer_.real_time_factor() : 0.0;
  state.late_ticks = pacer_.late_ticks();
  state.worst_lateness_ms = pacer_.worst_lateness_ms();
  state.state_hash = world_->state_hash();
  state.error = error_;
  return state;
}

void LiveSession::show_state() {
  SessionState state = describe();
  const std::lock_guard lock(state_mutex_);
  state_ = std::move(state);
}

void LiveSession::try_show_state() {
  const std::unique_lock lock(state_mutex_, std::try_to_lock);
  if (lock.owns_lock()) state_ = describe();
}

}  // namespace stagger::server
