// The commands of a LiveSession: each is handed to the simulation thread, and waited for.
#include <algorithm>

#include "server/live/live_session.h"

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

// How long an HTTP thread waits for an answer before it gives up.
constexpr auto command_patience = 5s;
constexpr auto step_patience = 300s;
constexpr std::size_t max_step_jobs = 16;

const sim::PushRecord& look_up(const std::vector<sim::PushRecord>& records, std::uint64_t id) {
  for (const sim::PushRecord& record : records) {
    if (record.id == id) return record;
  }
  throw CommandError(CommandError::Kind::not_found,
                     "there is no push " + std::to_string(id) + " in this session");
}

}  // namespace

void LiveSession::enqueue(Command command) {
  using Push = CommandQueue<Command>::Push;
  switch (queue_.push(std::move(command))) {
    case Push::taken:
      return;
    case Push::full:
      throw CommandError(CommandError::Kind::busy, "too many commands wait for the simulation");
    case Push::closed:
      throw CommandError(CommandError::Kind::stopping, "the server is stopping");
  }
}

template <typename T>
T LiveSession::call(std::function<T()> action) {
  auto ticket = std::make_shared<Ticket<T>>();
  enqueue({[this, ticket, action = std::move(action)] {
             if (!ticket->claim()) return;
             try {
               T value = action();
               show_state();
               ticket->answer(std::move(value));
             } catch (const CommandError& error) {
               ticket->fail(error);
             } catch (const std::exception& error) {
               break_down(error.what());
               ticket->fail(CommandError(CommandError::Kind::failed, error.what()));
             }
           },
           [ticket](const CommandError& error) { ticket->fail(error); }});
  return ticket->wait(command_patience);
}

Effect LiveSession::pause(const std::string& source) {
  return call<Effect>([this, source] {
    if (running_) {
      running_ = false;
      hub_.set_running(false);
      announce(now(), "pause", source);
      repeat_frame();
    }
    return now();
  });
}

Effect LiveSession::resume(const std::string& source) {
  return call<Effect>([this, source] {
    require_intact();
    if (!running_) {
      end_steps({CommandError::Kind::conflict, "the simulation was resumed before the step's end"});
      running_ = true;
      hub_.set_running(true);
      pacer_.restart(Clock::now());
      announce(now(), "resume", source);
    }
    return now();
  });
}

Effect LiveSession::step(std::uint64_t ticks, const std::string& source) {
  auto ticket = std::make_shared<Ticket<Effect>>();
  enqueue({[this, ticket, ticks, source] {
             if (!ticket->claim()) return;
             try {
               require_intact();
               if (running_) {
                 throw CommandError(CommandError::Kind::conflict,
                                    "the simulation is running; pause it first");
               }
               if (steps_.size() >= max_step_jobs) {
                 throw CommandError(CommandError::Kind::busy, "too many steps wait");
               }
               announce(now(), "step " + std::to_string(ticks), source,
                        {{"ticks", static_cast<double>(ticks)}});
               steps_.push_back({ticks, ticket});
             } catch (const CommandError& error) {
               ticket->fail(error);
             }
           },
           [ticket](const CommandError& error) { ticket->fail(error); }});
  return ticket->wait(step_patience);
}

Effect LiveSession::reset(const sim::SimulationConfig& config, const std::string& source) {
  const std::lock_guard lock(reset_mutex_);
  // Shared with the action, so that the old world is taken down by the caller too.
  auto world =
      std::make_shared<std::unique_ptr<sim::Simulation>>(std::make_unique<sim::Simulation>(config));
  return call<Effect>([this, world, source] {
    end_steps({CommandError::Kind::conflict, "the simulation was reset before the step's end"});
    world_.swap(*world);
    walk_ = {};
    error_.clear();
    open_pushes_.clear();
    start_session();
    announce(now(), "reset", source);
    return now();
  });
}

Effect LiveSession::walk(const engine::WalkCommand& command, const std::string& source) {
  return call<Effect>([this, command, source] {
    require_intact();
    world_->walk(command);
    walk_ = command;
    announce(now(), "walk", source, {{"vx", command.vx}, {"vy", command.vy}, {"wz", command.wz}});
    return now();
  });
}

Effect LiveSession::stop_walking(const std::string& source) {
  return call<Effect>([this, source] {
    require_intact();
    world_->stop_walking();
    walk_ = {};
    announce(now(), "stop", source);
    return now();
  });
}

StrategyEffect LiveSession::change_strategies(const StrategyChange& change,
                                              const std::string& source) {
  return call<StrategyEffect>([this, change, source] {
    require_intact();
    strategies_ = change(strategies_);
    world_->set_strategies(strategies_);
    announce(now(), "strategies", source,
             {{"ankle", strategies_.ankle ? 1.0 : 0.0},
              {"hip", strategies_.hip ? 1.0 : 0.0},
              {"step", strategies_.step ? 1.0 : 0.0},
              {"time", strategies_.time ? 1.0 : 0.0}});
    return StrategyEffect{now(), strategies_};
  });
}

sim::PushRecord LiveSession::push(const sim::PushSpec& spec, const std::string& source) {
  return call<sim::PushRecord>([this, spec, source] {
    require_intact();
    require_room_for_a_push();
    std::uint64_t id = 0;
    try {
      id = world_->push(spec);
    } catch (const std::invalid_argument& error) {
      throw CommandError(CommandError::Kind::invalid, error.what());
    }
    open_pushes_.push_back(id);
    announce(now(), "push " + std::to_string(id), source,
             {{"id", static_cast<double>(id)}, {"impulse_ns", spec.impulse_ns}});
    return world_->pushes().back();
  });
}

sim::PushRecord LiveSession::cancel_push(std::uint64_t id, const std::string& source) {
  return call<sim::PushRecord>([this, id, source] {
    const sim::PushRecord& record = look_up(world_->pushes(), id);
    if (record.state == sim::PushState::done) {
      throw CommandError(CommandError::Kind::conflict,
                         "push " + std::to_string(id) + " is done already");
    }
    if (record.state != sim::PushState::cancelled && world_->cancel_push(id)) {
      announce(now(), "cancel push " + std::to_string(id), source,
               {{"id", static_cast<double>(id)}});
    }
    return look_up(world_->pushes(), id);
  });
}

sim::PushRecord LiveSession::find_push(std::uint64_t id) {
  return call<sim::PushRecord>([this, id] { return look_up(world_->pushes(), id); });
}

std::vector<sim::PushRecord> LiveSession::pushes(std::uint64_t before, std::size_t limit) {
  return call<std::vector<sim::PushRecord>>([this, before, limit] {
    const auto& all = world_->pushes();
    std::vector<sim::PushRecord> page;
    for (auto record = all.rbegin(); record != all.rend() && page.size() < limit; ++record) {
      if (record->id < before) page.push_back(*record);
    }
    return page;
  });
}

}  // namespace stagger::server
