// The paper's walking state machine (section III-A): which state, which foot, how long already.
#pragma once

#include "engine/parameters.h"
#include "engine/walking_targets.h"

namespace stagger::engine {

/// What can make the state change at a tick.
struct StateInputs {
  bool swing_foot_loaded = false;  ///< the swing foot carries more than contact_load
};

/// What changed at a tick; the engine reacts to it.
enum class Transition : std::uint8_t { none, begin_shift, lift_off, landing, stand };

/// Timer t of eq. (1) runs from lift-off over single and double support and is reset at the end of
/// double support. Knows of time, feet and commands to start and stop; of nothing else.
class StateMachine {
 public:
  explicit StateMachine(const Parameters& parameters);

  void start();  ///< walk from the next tick on
  void stop();   ///< one whole step more, then stand on both feet

  /// Looks whether the present state ends now. At most one transition a call: call again until it
  /// says none (a double support of no duration is entered and left within one tick).
  Transition advance(const StateInputs& inputs);
  /// Lets one control period pass.
  void pass(double dt) { time_ += dt; }

  WalkingState state() const { return state_; }
  Side support_side() const { return support_; }
  double time() const { return time_; }
  double t_ss() const { return t_ss_; }
  double t_ds() const { return t_ds_; }
  /// Time of single support still to come; 0 when waiting for a late landing [s].
  double single_support_left() const { return time_ < t_ss_ ? t_ss_ - time_ : 0.0; }
  double double_support_left() const { return t_ss_ + t_ds_ - time_; }
  std::uint64_t landings() const { return landings_; }
  bool walking() const { return walking_; }
  /// Steps still to be landed, the one under way included; never more than preview_steps.
  std::size_t steps_ahead() const;
  /// The double support under way (or the next one, with one step ahead) ends in standing.
  bool ends_standing() const { return !walking_ && steps_left_ <= preview_steps; }

 private:
  void enter_single_support();

  double nominal_t_ss_;
  double nominal_t_ds_;
  double t_init_;
  double patience_;
  WalkingState state_ = WalkingState::idle;
  Side support_ = Side::left;
  double time_ = 0.0;
  double t_ss_;
  double t_ds_;
  std::uint64_t landings_ = 0;
  bool walking_ = false;
  std::size_t steps_left_ = 0;  ///< until standing; meaningless while walking_
};

}  // namespace stagger::engine
