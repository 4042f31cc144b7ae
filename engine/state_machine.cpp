#include "engine/state_machine.h"

#include <algorithm>

namespace stagger::engine {

StateMachine::StateMachine(const Parameters& parameters)
    : nominal_{parameters.t_ss, parameters.t_ds},
      t_init_(parameters.t_init),
      patience_(parameters.landing_patience),
      t_ss_(parameters.t_ss),
      t_ds_(parameters.t_ds) {}

void StateMachine::stop() {
  std::size_t needed = 0;
  if (state_ == WalkingState::single_support) {
    needed = 2;  // the swing under way was planned to go on from, not to stand on
  } else if (state_ == WalkingState::double_support) {
    needed = 1;
  }
  steps_left_ = std::min(steps_left_, needed);
}

std::size_t StateMachine::steps_ahead() const {
  return state_ == WalkingState::idle ? 0 : std::min(steps_left_, preview_steps);
}

void StateMachine::enter_single_support() {
  state_ = WalkingState::single_support;
  t_ss_ = nominal_.t_ss;
  t_ds_ = nominal_.t_ds;
}

Transition StateMachine::advance(const StateInputs& inputs) {
  // Times are sums of ticks: this keeps a sum that was rounded down from costing a whole tick.
  constexpr double rounding = 1e-9;
  switch (state_) {
    case WalkingState::idle:
      if (!walking()) return Transition::none;
      state_ = WalkingState::initialize;
      time_ = 0.0;
      return Transition::begin_shift;

    case WalkingState::initialize:
      if (!walking()) {
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
      if (steps_left_ != unlimited && steps_left_ > 0) --steps_left_;
      if (steps_left_ == 0) t_ds_ = t_init_;
      return Transition::landing;
    }

    case WalkingState::double_support:
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
