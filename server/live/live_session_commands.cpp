// The commands of a LiveSession: each is handed to the simulation thread, and waited for.
#include <algorithm>
#include <cmath>
#include <numbers>

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

std::vector<sim::Footstep> from_robot(std::vector<sim::Footstep> steps, const sim::Frame& frame) {
  const sim::FootPose& left = frame.feet[0];
  const sim::FootPose& right = frame.feet[1];
  const double yaw = left.yaw + 0.5 * std::remainder(right.yaw - left.yaw, 2.0 * std::numbers::pi);
  const sim::Vec2 middle = 0.5 * (left.position + right.position).head<2>();
  for (sim::Footstep& step : steps) {
    step.position = middle + engine::rotated(step.position, yaw);
    step.yaw += yaw;
  }
  return steps;
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
    apply(sim::Walk{command});
    walk_ = command;
    announce(now(), "walk", source, {{"vx", command.vx}, {"vy", command.vy}, {"wz", command.wz}});
    return now();
  });
}

Effect LiveSession::follow(const std::vector<sim::Footstep>& steps, StepFrame frame,
                           const std::string& source) {
  struct Answer {
    Effect effect;
    std::optional<std::size_t> refused;
    std::string why;
  };
  const Answer answer = call<Answer>([this, steps, frame, source] {
    require_intact();
    if (world_->frame().fallen) {
      throw CommandError(CommandError::Kind::conflict, "the robot has fallen");
    }
    try {
      apply(
          sim::FollowSteps{frame == StepFrame::robot ? from_robot(steps, world_->frame()) : steps});
    } catch (const sim::StepListRefused& error) {
      if (error.step) return Answer{now(), error.step, error.what()};
      throw CommandError(CommandError::Kind::conflict, error.what());
    }
    walk_ = {};
    announce(now(), "steps", source, {{"steps", static_cast<double>(steps.size())}});
    return Answer{now(), std::nullopt, ""};
  });
  if (answer.refused) throw StepsRefused(answer.why, *answer.refused);
  return answer.effect;
}

Effect LiveSession::stop_walking(const std::string& source) {
  return call<Effect>([this, source] {
    require_intact();
    apply(sim::StopWalking{});
    walk_ = {};
    announce(now(), "stop", source);
    return now();
  });
}

StrategyEffect LiveSession::change_strategies(const StrategyChange& change,
                                              const std::string& source) {
  return call<StrategyEffect>([this, change, source] {
    require_intact();
    set_strategies(change(strategies_), source);
    return StrategyEffect{now(), strategies_};
  });
}

void LiveSession::set_strategies(const engine::Strategies& chosen, const std::string& source) {
  strategies_ = chosen;
  apply(sim::SetStrategies{strategies_});
  announce(now(), "strategies", source,
           {{"ankle", strategies_.ankle ? 1.0 : 0.0},
            {"hip", strategies_.hip ? 1.0 : 0.0},
            {"step", strategies_.step ? 1.0 : 0.0},
            {"time", strategies_.time ? 1.0 : 0.0}});
}

ParameterEffect LiveSession::change_parameters(const ParameterChange& change,
                                               const std::string& source,
                                               const std::optional<engine::Strategies>& chosen) {
  const std::lock_guard lock(reset_mutex_);
  const SessionState present = state();
  const sim::SimulationConfig config = hub_.session()->config;
  const sim::ParameterValues wanted = change(*present.parameters);
  auto faults = sim::check_parameters(config, wanted);
  // What the living world makes of them has to go together as well.
  if (faults.empty()) {
    faults = sim::check_parameters(config, sim::live_part(wanted, *present.active_parameters));
  }
  if (!faults.empty()) throw ParametersRefused(std::move(faults));
  return call<ParameterEffect>([this, wanted, chosen, source] {
    require_intact();
    if (chosen) set_strategies(*chosen, source);
    std::vector<std::pair<std::string, double>> told;
    for (const auto& [name, value] : wanted) {
      const auto before = parameters_->find(name);
      if (before == parameters_->end() || before->second != value) told.emplace_back(name, value);
    }
    apply(sim::SetParameters{wanted});
    parameters_ = std::make_shared<const sim::ParameterValues>(wanted);
    announce(now(), "parameters", source, std::move(told));
    return ParameterEffect{now(), wanted, world_->active_parameters()};
  });
}

Effect LiveSession::set_speed(std::optional<double> factor, const std::string& source) {
  return call<Effect>([this, factor, source] {
    pacer_.set_speed(factor, Clock::now());
    // Without a pace it takes all the time that there is: then it must not take it from the others.
    set_priority(factor.has_value());
    if (factor) {
      announce(now(), "speed", source, {{"factor", *factor}});
    } else {
      announce(now(), "speed max", source);
    }
    return now();
  });
}

sim::PushRecord LiveSession::push(const sim::PushSpec& spec, const std::string& source) {
  return call<sim::PushRecord>([this, spec, source] {
    require_intact();
    require_room_for_a_push();
    try {
      apply(sim::StartPush{spec});
    } catch (const std::invalid_argument& error) {
      throw CommandError(CommandError::Kind::invalid, error.what());
    }
    const std::uint64_t id = world_->pushes().back().id;
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
    if (record.state != sim::PushState::cancelled) {
      apply(sim::CancelPush{id});
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
