// The paper's walking state machine (section III-A): which state, which foot, how long already.
#pragma once

#include "engine/step_timing.h"
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

  /// More changes within a tick can only come from durations that are none.
  static constexpr int most_transitions = 4;
  static constexpr std::size_t unlimited = static_cast<std::size_t>(-1);

  /// Walk from the next tick on, for so many landings. When the step under way is the last of a
  /// walk that is ending, or has landed already, the CoM is on its way to stand: then that landing
  /// is not counted, and Initialize begins right after it, with the weight going to the foot that
  /// landed.
  void start(std::size_t steps = unlimited);
  /// One whole step more, then stand on both feet. From the second half of a swing on that is the
  /// step after the next: by then the CoM goes too fast for the one under way.
  void stop();
  /// After the last landing: takes a further step before it stands.
  void step_again();
  /// From standing, Initialize, or a double support that closes: single support on this foot begins
  /// now. Goes on walking as it was told to, or comes to stand with the step after this one.
  void recover(Side support);
  /// Durations of the steps that begin from now on [s].
  void set_times(const StepTimes& times) { nominal_ = times; }
  /// Initialize (the next one) and the patience with a late landing [s].
  void set_waits(double t_init, double patience) {
    t_init_ = t_init;
    patience_ = patience;
  }
  /// Which foot stands first; only while idle.
  void set_support_side(Side side) { support_ = side; }

  /// Looks whether the present state ends now. At most one transition a call: call again until it
  /// says none (a double support of no duration is entered and left within one tick), but no more
  /// than most_transitions times.
  Transition advance(const StateInputs& inputs);
  /// Lets one control period pass.
  void pass(double dt) { time_ += dt; }

  WalkingState state() const { return state_; }
  /// Adjusts the duration of the single support under way; not below the time that has passed.
  void set_t_ss(double t_ss) { t_ss_ = t_ss > time_ ? t_ss : time_; }

  Side support_side() const { return support_; }
  /// t of eq. (1); in idle and Initialize since these began [s].
  double time() const { return time_; }
  double t_ss() const { return t_ss_; }
  double t_ds() const { return t_ds_; }
  /// Time of single support still to come; 0 when waiting for a late landing [s].
  double single_support_left() const { return time_ < t_ss_ ? t_ss_ - time_ : 0.0; }
  /// From here on a swing foot that meets the ground has landed.
  bool past_mid_swing() const { return time_ > 0.5 * t_ss_; }
  double double_support_left() const { return t_ss_ + t_ds_ - time_; }
  std::uint64_t landings() const { return landings_; }
  bool walking() const { return steps_left_ > 0; }
  /// This double support takes the weight to the middle, to stand.
  bool closing() const { return closing_; }
  /// Both feet stand, and a step can begin with either.
  bool stands() const {
    return closing_ || state_ == WalkingState::idle || state_ == WalkingState::initialize;
  }
  /// The single support under way ends in standing.
  bool last_step() const { return state_ == WalkingState::single_support && steps_left_ == 1; }
  /// Steps still to be landed, the one under way included; never more than preview_steps.
  std::size_t steps_ahead() const;
  /// The last of steps_ahead() (or the double support under way) ends in standing.
  bool ends_standing() const { return steps_left_ <= preview_steps; }

 private:
  void enter_single_support();
  Transition begin_shift();

  StepTimes nominal_;
  double t_init_;
  double patience_;
  WalkingState state_ = WalkingState::idle;
  Side support_ = Side::left;
  double time_ = 0.0;
  double t_ss_;
  double t_ds_;
  bool closing_ = false;
  std::uint64_t landings_ = 0;
  std::size_t steps_left_ = 0;  ///< landings until standing
  std::size_t steps_then_ = 0;  ///< of a new walk that begins with the next landing
};

}  // namespace stagger::engine
