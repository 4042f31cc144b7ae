// The world that people watch: one thread owns the simulation and keeps it at the wall clock's
// pace.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/live/command_queue.h"
#include "server/live/event_log.h"
#include "server/live/frame_hub.h"
#include "server/live/pacer.h"
#include "server/live/ticket.h"
#include "sim/parameter_table.h"
#include "sim/simulation.h"
#include "sim/world_command.h"

namespace stagger::server {

/// When a command took effect: the first tick that it acts on. That is the tick that runs next.
struct Effect {
  std::uint64_t tick = 0;
  double time_s = 0.0;
};

struct StrategyEffect {
  Effect effect;
  engine::Strategies strategies;  ///< all of them, as they are now
};

struct ParameterEffect {
  Effect effect;
  sim::ParameterValues wanted;  ///< all of them, as they are now
  sim::ParameterValues active;  ///< of these, what is in effect already
};

/// Parameters that cannot be; nothing has changed.
class ParametersRefused : public std::runtime_error {
 public:
  explicit ParametersRefused(std::vector<sim::ParameterFault> list)
      : std::runtime_error("the parameters are not valid"), faults(std::move(list)) {}
  std::vector<sim::ParameterFault> faults;
};

/// In which frame a list of steps is told.
enum class StepFrame : std::uint8_t {
  world,
  robot  ///< origin in the middle between the feet, x along their mean heading
};

/// A list of steps that cannot be walked; nothing has changed.
class StepsRefused : public std::runtime_error {
 public:
  StepsRefused(const std::string& why, std::size_t at) : std::runtime_error(why), step(at) {}
  std::size_t step;
};

/// What GET /api/v1/simulation tells, but for the stream's own counters.
struct SessionState {
  std::string session_id;
  std::string robot;
  sim::PlantKind plant = sim::PlantKind::bullet;
  std::uint64_t seed = 0;
  sim::TerrainParameters terrain;
  std::uint64_t tick = 0;  ///< that runs next; the last frame is of the tick before
  double time_s = 0.0;
  bool running = false;
  sim::WalkingState walking_state = sim::WalkingState::idle;
  bool fallen = false;
  std::string fall_reason;
  engine::Strategies strategies;
  sim::SenseParameters senses;
  engine::WalkCommand walk;
  std::uint64_t step_count = 0;
  double worst_dcm_error_m = 0.0;
  std::optional<double> speed;  ///< asked for; nothing: as fast as it goes
  double real_time_factor = 0.0;
  std::uint64_t late_ticks = 0;
  double worst_lateness_ms = 0.0;
  std::uint64_t state_hash = 0;
  std::string error;  ///< why the simulation broke down; it takes a reset to go on
  std::shared_ptr<const sim::ParameterValues> parameters;         ///< asked for; of the next world
  std::shared_ptr<const sim::ParameterValues> active_parameters;  ///< in effect
};

/// What has happened since the program began, over all resets.
struct SessionCounters {
  std::uint64_t ticks = 0;
  std::uint64_t steps = 0;
  std::uint64_t pushes = 0;  ///< that began to act
  std::uint64_t falls = 0;
  std::uint64_t sessions = 0;
  std::size_t waiting_commands = 0;  ///< at this moment
};

/// Commands may come from any thread. Each waits until the simulation thread has carried it out and
/// throws CommandError when it could not. `source` says who sent it, for everyone who listens.
class LiveSession {
 public:
  static constexpr std::size_t queue_capacity = 256;
  static constexpr std::uint64_t max_step_ticks = 10000;
  /// Pushes that wait or act at a time: every tick looks at each of them.
  static constexpr std::size_t max_open_pushes = 1000;
  /// Pushes of one session, done ones included.
  static constexpr std::size_t max_pushes = 100000;
  static constexpr double slowest = 0.01;  ///< simulated seconds in a second
  static constexpr double fastest = 1000.0;

  /// Builds the world and starts the thread. Throws what the simulation's constructor throws.
  LiveSession(const sim::SimulationConfig& config, FrameHub& hub, bool walk_at_start);
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  /// Ends the thread; commands that wait fail. May be called again.
  void stop();

  /// Never waits for the simulation thread.
  SessionState state() const;
  SessionCounters counters() const;

  Effect pause(const std::string& source);
  Effect resume(const std::string& source);
  /// Only while paused; returns when the ticks have been done.
  Effect step(std::uint64_t ticks, const std::string& source);
  /// Replaces the world; it runs or stays paused as before. The new one is built in the calling
  /// thread, so that nobody waits for it but the caller.
  Effect reset(const sim::SimulationConfig& config, const std::string& source);
  Effect walk(const engine::WalkCommand& command, const std::string& source);
  /// Throws StepsRefused, and CommandError when the robot does not stand.
  Effect follow(const std::vector<sim::Footstep>& steps, StepFrame frame,
                const std::string& source);
  Effect stop_walking(const std::string& source);
  /// From `slowest` to `fastest`; nothing: as fast as it goes.
  Effect set_speed(std::optional<double> factor, const std::string& source);
  using ParameterChange = std::function<sim::ParameterValues(const sim::ParameterValues&)>;
  /// All of what `change` makes of the present ones, or nothing: throws ParametersRefused. Those
  /// that take a new world wait for the next reset. Strategies that are `chosen` change in the same
  /// tick.
  ParameterEffect change_parameters(const ParameterChange& change, const std::string& source,
                                    const std::optional<engine::Strategies>& chosen = {});
  using StrategyChange = std::function<engine::Strategies(engine::Strategies)>;
  StrategyEffect change_strategies(const StrategyChange& change, const std::string& source);
  sim::PushRecord push(const sim::PushSpec& spec, const std::string& source);
  sim::PushRecord cancel_push(std::uint64_t id, const std::string& source);
  sim::PushRecord find_push(std::uint64_t id);
  /// Newest first, those with an id below `before`.
  std::vector<sim::PushRecord> pushes(std::uint64_t before, std::size_t limit);
  /// What happened in this session.
  const EventLog& events() const { return events_; }

 private:
  using Clock = std::chrono::steady_clock;

  struct Command {
    std::function<void()> run;
    std::function<void(const CommandError&)> refuse;
  };
  struct StepJob {
    std::uint64_t ticks_left = 0;
    std::shared_ptr<Ticket<Effect>> ticket;
  };

  /// Runs `action` in the simulation thread and returns what it returns.
  template <typename T>
  T call(std::function<T()> action);
  void enqueue(Command command);

  // All below: the simulation thread only.
  void run();
  void wait_for_tick();
  void set_priority(bool high) const;
  void run_tick();
  void run_steps();
  void advance();
  void make_frame();
  void count(sim::EventKind kind);
  void repeat_frame();
  void start_session();
  void break_down(const std::string& why);
  void end_steps(const CommandError& why);
  /// Carries a command out and keeps it in the journal.
  void apply(const sim::WorldCommand& command);
  void require_intact() const;
  void require_room_for_a_push();
  void publish(const EventPtr& event);
  void set_strategies(const engine::Strategies& chosen, const std::string& source);
  Effect now() const;
  void announce(const Effect& effect, std::string text, const std::string& source,
                std::vector<std::pair<std::string, double>> values = {});
  SessionState describe() const;
  void show_state();      ///< waits for readers, so that an answered command shows
  void try_show_state();  ///< a tick never waits for a reader

  FrameHub& hub_;
  CommandQueue<Command> queue_{queue_capacity};
  std::unique_ptr<sim::Simulation> world_;
  SessionPtr session_;
  FramePtr frame_;
  EventLog events_;
  engine::Strategies strategies_;
  std::shared_ptr<const sim::ParameterValues> parameters_;
  std::shared_ptr<const sim::ParameterValues> active_parameters_;
  engine::WalkCommand walk_;
  Pacer pacer_;
  bool running_ = true;
  int normal_nice_ = 0;  ///< of this thread, before it was raised
  std::string error_;
  std::deque<StepJob> steps_;
  std::vector<std::uint64_t> open_pushes_;  ///< ids

  struct Counts {
    std::atomic<std::uint64_t> ticks{0};
    std::atomic<std::uint64_t> steps{0};
    std::atomic<std::uint64_t> pushes{0};
    std::atomic<std::uint64_t> falls{0};
    std::atomic<std::uint64_t> sessions{0};
  };
  Counts counts_;

  /// One new world, or other parameters, at a time; not for the simulation thread.
  std::mutex reset_mutex_;
  mutable std::mutex state_mutex_;
  SessionState state_;
  std::thread thread_;
};

}  // namespace stagger::server
