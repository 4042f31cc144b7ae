#include "engine/state_machine.h"

namespace stagger::engine {

StateMachine::StateMachine(const Parameters& parameters)
    : nominal_t_ss_(parameters.t_ss),
      nominal_t_ds_(parameters.t_ds),
      t_init_(parameters.t_init),
      patience_(parameters.landing_patience),
      t_ss_(parameters.t_ss),
      t_ds_(parameters.t_ds) {}

void StateMachine::start() { walking_ = true; }

void StateMachine::stop() {
  if (!walking_) return;
  walking_ = false;
  switch (state_) {
    case WalkingState::idle:
    case WalkingState::initialize:
      steps_left_ = 0;
      break;
    case WalkingState::single_support:
      steps_left_ = 2;  // the swing under way was planned to go on from, not to stand on
      break;
    case WalkingState::double_support:
      steps_left_ = 1;
      break;
  }
}

std::size_t StateMachine::steps_ahead() const {
  if (walking_) return state_ == WalkingState::idle ? 0 : preview_steps;
  return steps_left_;
}

void StateMachine::enter_single_support() {
  state_ = WalkingState::single_support;
  t_ss_ = nominal_t_ss_;
  t_ds_ = nominal_t_ds_;
}

Transition StateMachine::advance(const StateInputs& inputs) {
  // Times are sums of ticks: this keeps a sum that was rounded down from costing a whole tick.
  constexpr double rounding = 1e-9;
  switch (state_) {
    case WalkingState::idle:
      if (!walking_) return Transition::none;
      state_ = WalkingState::initialize;
      time_ = 0.0;
      return Transition::begin_shift;

    case WalkingState::initialize:
      if (!walking_) {
        state_ = WalkingState::idle;
        return Transition::stand;
      }
      if (time_ < t_init_ - rounding) return Transition::none;
      time_ -= t_init_;
      enter_single_support();
      return Transition::lift_off;

    case WalkingState::single_support: {
      const bool in_time = time_ >= t_ss_ - rounding;
      const bool early = inputs.swing_foot_loaded && time_ > 0.5 * t_ss_;
      const bool patient = in_time && !inputs.swing_foot_loaded && time_ < t_ss_ + patience_;
      if ((!in_time && !early) || patient) return Transition::none;
      if (early || time_ > t_ss_ + rounding) t_ss_ = time_;  // the double support begins now
      state_ = WalkingState::double_support;
      ++landings_;
      if (!walking_ && steps_left_ > 0) --steps_left_;
      if (!walking_ && steps_left_ == 0) t_ds_ = t_init_;
      return Transition::landing;
    }

    case WalkingState::double_support:
      if (time_ < t_ss_ + t_ds_ - rounding) return Transition::none;
      time_ -= t_ss_ + t_ds_;
      support_ = other(support_);
      if (!walking_ && steps_left_ == 0) {
        state_ = WalkingState::idle;
        return Transition::stand;
      }
      enter_single_support();
      return Transition::lift_off;
  }
  return Transition::none;
}

}  // namespace stagger::engine
