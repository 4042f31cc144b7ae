#include "engine/state_machine.h"

#include <algorithm>
#include <utility>

namespace stagger::engine {

StateMachine::StateMachine(const Parameters& parameters)
    : nominal_{parameters.t_ss, parameters.t_ds},
      t_init_(parameters.t_init),
      patience_(parameters.landing_patience),
      t_ss_(parameters.t_ss),
      t_ds_(parameters.t_ds) {}

void StateMachine::start(std::size_t steps) {
  if (last_step()) {
    steps_then_ = steps;
  } else {
    steps_left_ = steps;
  }
}

void StateMachine::stop() {
  steps_then_ = 0;
  std::size_t needed = 0;
  if (state_ == WalkingState::single_support) {
    needed = past_mid_swing() ? 3 : 2;
  } else if (state_ == WalkingState::double_support) {
    needed = 2;
  }
  steps_left_ = std::min(steps_left_, needed);
}

void StateMachine::step_again() {
  if (!closing_) return;
  closing_ = false;
  t_ds_ = nominal_.t_ds;
  steps_left_ = 1;
}

void StateMachine::recover(Side support) {
  if (!stands()) return;
  support_ = support;
  time_ = 0.0;
  closing_ = false;
  enter_single_support();
  constexpr std::size_t needed = 2;  // one that catches, one that closes
  steps_left_ = std::max(steps_left_, needed);
}

std::size_t StateMachine::steps_ahead() const {
  return state_ == WalkingState::idle ? 0 : std::min(steps_left_, preview_steps);
}

void StateMachine::enter_single_support() {
  state_ = WalkingState::single_support;
  t_ss_ = nominal_.t_ss;
  t_ds_ = nominal_.t_ds;
}

Transition StateMachine::begin_shift() {
  state_ = WalkingState::initialize;
  time_ = 0.0;
  closing_ = false;
  return Transition::begin_shift;
}

Transition StateMachine::advance(const StateInputs& inputs) {
  // Times are sums of ticks: this keeps a sum that was rounded down from costing a whole tick.
  constexpr double rounding = 1e-9;
  switch (state_) {
    case WalkingState::idle:
      return walking() ? begin_shift() : Transition::none;

    case WalkingState::initialize:
      if (!walking()) {
        state_ = WalkingState::idle;
        time_ = 0.0;
        return Transition::stand;
      }
      if (time_ < t_init_ - rounding) return Transition::none;
      time_ -= t_init_;
      enter_single_support();
      return Transition::lift_off;

    case WalkingState::single_support: {
      const bool in_time = time_ >= t_ss_ - rounding;
      const bool early = inputs.swing_foot_loaded && past_mid_swing();
      const bool patient = in_time && !inputs.swing_foot_loaded && time_ < t_ss_ + patience_;
      if ((!in_time && !early) || patient) return Transition::none;
      if (early || time_ > t_ss_ + rounding) t_ss_ = time_;  // the double support begins now
      state_ = WalkingState::double_support;
      ++landings_;
      if (steps_left_ != unlimited && steps_left_ > 0) --steps_left_;
      closing_ = steps_left_ == 0;
      if (closing_) {
        t_ds_ = t_init_;
        steps_left_ = std::exchange(steps_then_, 0);
      }
      return Transition::landing;
    }

    case WalkingState::double_support:
      if (closing_ && walking()) {
        support_ = other(support_);
        return begin_shift();
      }
      if (time_ < t_ss_ + t_ds_ - rounding) return Transition::none;
      time_ -= t_ss_ + t_ds_;
      support_ = other(support_);
      if (!walking()) {
        state_ = WalkingState::idle;
        return Transition::stand;
      }
      enter_single_support();
      return Transition::lift_off;
  }
  return Transition::none;
}

}  // namespace stagger::engine
