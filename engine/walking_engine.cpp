#include "engine/walking_engine.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "engine/step_limits.h"

namespace stagger::engine {
namespace {

/// Steps that may follow the last one of a walk because the feet do not stand side by side.
constexpr int most_corrections = 2;
/// The same after a recovery, which leaves them far apart.
constexpr int most_recovery_corrections = 6;

Footstep footstep(const FootPose& pose, Side side) {
  return {pose.position.head<2>(), pose.yaw, side};
}

WalkingEngine::StepListError list_error(StepFault fault) {
  using Error = WalkingEngine::StepListError;
  switch (fault) {
    case StepFault::none:
      break;
    case StepFault::out_of_reach:
      return Error::out_of_reach;
    case StepFault::turns_too_far:
      return Error::turns_too_far;
    case StepFault::soles_too_near:
      return Error::soles_too_near;
  }
  return Error::none;
}

}  // namespace

WalkingEngine::WalkingEngine(const Parameters& parameters, const Measurement& start, Layout)
    : WalkingEngine(parameters, start, ReachRegion(validate(parameters))) {}

WalkingEngine::WalkingEngine(const Parameters& parameters, const Measurement& start,
                             const ReachRegion& reach, Layout)
    : parameters_(validate(parameters)),
      omega_(natural_frequency(parameters)),
      sole_(usable_sole(parameters)),
      reach_(reach),
      time_reach_(reach.scaled_length(parameters.time_reach)),
      capture_(parameters, reach),
      recovery_(parameters, reach),
      machine_(parameters),
      lqg_(parameters),
      hip_(parameters.hip, parameters.mass * parameters.gravity, omega_, parameters.tick),
      pattern_(step_pattern({}, reach, parameters)),
      coming_{pattern_, pattern_},
      measured_(start),
      standing_(start.feet),
      swing_(parameters.landing_speed, parameters.landing_acceleration) {
  validate(start);
  stance_ = footstep(start.feet[index(Side::left)], Side::left);
  landed_ = footstep(start.feet[index(Side::right)], Side::right);
  planned_ = landed_;
  swing_goal_ = landed_;
  polygon_ = engine::support_polygon(sole_, start.feet[0], start.feet[1]);
  // It is to stand in the middle; if it does not, beyond what the noise of one measurement
  // explains, it is taken there smoothly.
  const Vec2 com = start.com.head<2>();
  const Vec2 dcm = com + start.com_velocity.head<2>() / omega_;
  const double doubt = 3.0 * std::sqrt(parameters_.measurement_noise);
  const bool off = std::max((com - middle()).norm(), (dcm - middle()).norm()) > doubt;
  com_reference_ = off ? com : middle();
  begin_rest(off ? dcm : middle());
}

void WalkingEngine::set_pattern(const WalkCommand& command, std::size_t kept) {
  wish_ = command;
  pattern_ = waiting_ ? step_pattern(command, waiting_->reach, waiting_->parameters)
                      : step_pattern(command, reach_, parameters_);
  steps_before_change_ = std::min(steps_before_change_, kept);
  for (std::size_t i = kept; i < coming_.size(); ++i) coming_[i] = pattern_;
  machine_.set_times(coming_[0].times);
  list_size_ = std::min(list_size_, list_next_ + kept);
}

std::size_t WalkingEngine::committed_steps() const {
  const WalkingState state = machine_.state();
  if (state == WalkingState::idle || !machine_.walking()) return 0;
  return state == WalkingState::single_support && !machine_.last_step() ? 2 : 1;
}

bool WalkingEngine::change(const Tuning& tuning) {
  if (!same_body(tuning.parameters, parameters_)) return false;
  waiting_ = tuning;
  if (list_next_ < list_size_) {
    steps_before_change_ = std::numeric_limits<std::size_t>::max();
  } else {
    steps_before_change_ = committed_steps();
    set_pattern(wish_, steps_before_change_);
  }
  return true;
}

void WalkingEngine::retune() {
  const Strategies strategies = parameters_.strategies;
  parameters_ = waiting_->parameters;
  parameters_.strategies = strategies;
  reach_ = waiting_->reach;
  time_reach_ = waiting_->time_reach;
  capture_ = waiting_->capture;
  recovery_ = waiting_->recovery;
  lqg_.retune(waiting_->lqg);
  machine_.set_waits(parameters_.t_init, parameters_.landing_patience);
  swing_.set_landing(parameters_.landing_speed, parameters_.landing_acceleration);
  waiting_.reset();
  // After a list the gait is still the old one.
  if (machine_.state() == WalkingState::idle) set_pattern(wish_, 0);
}

void WalkingEngine::walk(const WalkCommand& command) {
  // The weight shift begins anew, from wherever the CoM is by then.
  if (waiting_ && machine_.state() == WalkingState::idle) retune();
  set_pattern(command, committed_steps());
  stands_as_told_ = false;
  recovering_ = false;
  corrections_left_ = 0;
  machine_.start();
}

void WalkingEngine::stop() {
  if (machine_.walking()) stands_as_told_ = false;
  machine_.stop();
  // The last step closes the feet, unless it is under way already.
  const std::size_t under_way = machine_.state() == WalkingState::single_support ? 1 : 0;
  const std::size_t ahead = machine_.steps_ahead();
  set_pattern({}, std::max(under_way, ahead > 0 ? ahead - 1 : 0));
  corrections_left_ = std::max(corrections_left_, most_corrections);
}

WalkingEngine::StepListError WalkingEngine::follow(std::span<const Footstep> steps,
                                                   std::size_t* refused) {
  if (machine_.state() != WalkingState::idle) return StepListError::walking;
  if (steps.size() > max_listed_steps) return StepListError::too_long;
  if (steps.empty()) return StepListError::none;
  if (waiting_) retune();
  // The first step starts from the other foot, wherever that stands now.
  Footstep from = stance_.side == steps[0].side ? landed_ : stance_;
  for (const Footstep& step : steps) {
    if (refused != nullptr) *refused = static_cast<std::size_t>(&step - steps.data());
    if (step.side == from.side) return StepListError::wrong_side;
    const StepFault fault = check_step(from, step, reach_, parameters_);
    if (fault != StepFault::none) return list_error(fault);
    from = step;
  }
  set_pattern({}, 0);
  stands_as_told_ = true;
  corrections_left_ = 0;
  std::copy(steps.begin(), steps.end(), list_.begin());
  list_size_ = steps.size();
  list_next_ = 0;
  machine_.set_support_side(other(steps[0].side));
  machine_.start(steps.size());
  return StepListError::none;
}

Vec2 WalkingEngine::middle() const { return 0.5 * (stance_.position + landed_.position); }

FootPose WalkingEngine::landing_pose(const Footstep& step) const {
  // The ground is taken to go on from under the stance foot as it did so far.
  const double ground = standing_[index(stance_.side)].position.z();
  const double rise = ground_.rise(step.position - stance_.position);
  return {Vec3(step.position.x(), step.position.y(), ground + rise), step.yaw};
}

bool WalkingEngine::take(const Measurement& measurement) {
  for (std::size_t foot = 0; foot < 2; ++foot) {
    if (plausible(measurement.feet[foot])) measured_.feet[foot] = measurement.feet[foot];
    const double load = measurement.foot_load[foot];
    if (plausible(load)) measured_.foot_load[foot] = load;
  }
  const bool seen = plausible(measurement.com) && plausible(measurement.com_velocity);
  if (seen) {
    measured_.com = measurement.com;
    measured_.com_velocity = measurement.com_velocity;
  }
  return seen;
}

const WalkingTargets& WalkingEngine::update(const Measurement& measurement) {
  // On its way to the middle it would have to jump.
  if (waiting_ && machine_.state() == WalkingState::idle &&
      machine_.time() >= std::max(parameters_.t_init, waiting_->parameters.t_init)) {
    retune();
  }
  // Never seen yet, or not for so long that the prediction has run away: then the last one known.
  const bool lost = !estimating_ || !plausible(lqg_.dcm().norm());
  if (take(measurement) || lost) {
    const Vec2 com = measured_.com.head<2>();
    lqg_.estimate(com, com + measured_.com_velocity.head<2>() / omega_);
    estimating_ = true;
    recover();
    mend_stance();
  }

  const Side swing_side = other(machine_.support_side());
  StateInputs inputs;
  inputs.swing_foot_loaded = measured_.foot_load[index(swing_side)] > parameters_.contact_load;
  for (int i = 0; i < StateMachine::most_transitions; ++i) {
    const Transition transition = machine_.advance(inputs);
    if (transition == Transition::none) break;
    react(transition);
  }

  const bool single = machine_.state() == WalkingState::single_support;
  plan_steps(machine_.state() == WalkingState::double_support ? landed_ : stance_, 0);
  planned_ = step_count_ > 0 ? steps_[0] : landed_;
  plan_reference();
  adjusting_ = false;
  if (single) {
    polygon_ = engine::support_polygon(sole_, measured_.feet[index(stance_.side)]);
    settle_stance_foot();
    adjust();
    move_swing_foot();
  } else {
    polygon_ = engine::support_polygon(sole_, measured_.feet[0], measured_.feet[1]);
  }
  use_hip();

  const LqgReference reference{com_reference_, plan_.dcm(), plan_.zmp()};
  publish(reference);
  targets_.zmp_command = lqg_.control(reference, polygon_, hip_aid_, parameters_.strategies.ankle,
                                      !adjusting_, goal());
  com_reference_ = plan_.advance_com(com_reference_, parameters_.tick, omega_);
  machine_.pass(parameters_.tick);
  return targets_;
}

void WalkingEngine::settle_stance_foot() {
  // A foot that landed on its edge comes down when the weight comes onto it, in a hard step after
  // the other foot has left. One that tips up again in a push does not lift the ground.
  double& height = standing_[index(stance_.side)].position.z();
  height = std::min(height, measured_.feet[index(stance_.side)].position.z());
}

void WalkingEngine::recover() {
  const Strategies& use = parameters_.strategies;
  if (!use.step || !machine_.stands() ||
      !recovery_.needed(lqg_.dcm(), lqg_.dcm_deviation(), measured_.feet, use)) {
    return;
  }
  const Side support = recovery_.support_side(lqg_.dcm(), measured_.feet, use.time);
  // A walk goes on as commanded. So does a list, if it begins with the foot that has to step.
  const bool listed = list_next_ < list_size_;
  if (!machine_.walking() || (listed && list_[list_next_].side == support)) {
    machine_.stop();
    stands_as_told_ = false;
    set_pattern({}, 0);
    corrections_left_ = most_recovery_corrections;
  }
  recovering_ = true;
  machine_.recover(support);
  machine_.set_t_ss(recovery_.step_time(use.time));
  react(Transition::lift_off);
  plan_reference();
  if (use.time) adjust_step_time(situation(steps_[0]), 1.0);
  com_reference_ = lqg_.com();
}

void WalkingEngine::mend_stance() {
  // At the edge of a stone a foot may creep under a body at rest until that falls. And after steps
  // that had to catch it, it may have come to rest on any feet.
  constexpr double rest = 2.0;            // of t_init, which takes it to the middle
  constexpr double most_distance = 0.05;  // [m]
  constexpr double most_turn = 0.25;      // [rad]
  if (!parameters_.strategies.step || stands_as_told_ || machine_.walking() ||
      machine_.state() != WalkingState::idle || machine_.time() < rest * parameters_.t_init) {
    return;
  }
  const Side side = machine_.support_side();
  const StanceError error = stance_error(footstep(measured_.feet[index(side)], side),
                                         footstep(measured_.feet[index(other(side))], other(side)));
  if (error.distance < most_distance && error.turn < most_turn) return;
  set_pattern({}, 0);
  corrections_left_ = most_corrections;
  machine_.start(1);
}

void WalkingEngine::react(Transition transition) {
  const auto measured = [&](Side side) { return footstep(measured_.feet[index(side)], side); };
  switch (transition) {
    case Transition::none:
      break;
    case Transition::begin_shift:
      standing_ = measured_.feet;
      stance_ = measured(machine_.support_side());
      landed_ = measured(other(stance_.side));
      begin_shift();
      break;
    case Transition::lift_off:
      if (waiting_ && steps_before_change_ == 0) retune();
      stance_ = measured(machine_.support_side());
      standing_ = measured_.feet;
      nominal_t_ss_ = machine_.t_ss();
      plan_steps(stance_, 0);
      swing_goal_ = steps_[0];
      lifted_ = false;
      swing_.start(standing_[index(swing_goal_.side)], landing_pose(swing_goal_),
                   machine_.t_ss() - machine_.time(), parameters_.swing_height);
      break;
    case Transition::landing:
      landed_ = measured(other(machine_.support_side()));
      // From two places where a foot has stood for a while: one that lands does so on its edge.
      ground_.learn(standing_[index(landed_.side)].position,
                    standing_[index(stance_.side)].position);
      standing_[index(landed_.side)] = measured_.feet[index(landed_.side)];
      if (list_next_ < list_size_) ++list_next_;
      recovering_ = recovering_ && machine_.ends_standing();
      // A recovery first comes to rest where it can: from there a correction need not hurry.
      if (machine_.closing() && corrections_left_ > 0 && !stands_side_by_side() &&
          !(recovering_ && recovery_.can_stand(lqg_.dcm(), measured_.feet))) {
        --corrections_left_;
        machine_.step_again();
      }
      coming_ = {coming_[1], pattern_};
      if (steps_before_change_ > 0) --steps_before_change_;
      machine_.set_times(coming_[0].times);
      break;
    case Transition::stand:
      stance_ = measured(machine_.support_side());
      landed_ = measured(other(stance_.side));
      standing_ = measured_.feet;
      begin_rest(plan_.dcm_after(parameters_.tick, omega_));  // from where the reference was going
      recovering_ = recovering_ && corrections_left_ > 0 && !stands_side_by_side();
      if (recovering_) {
        --corrections_left_;
        machine_.start(1);
      }
      break;
  }
}

void WalkingEngine::begin_shift() {
  plan_steps(stance_, 0);
  // The plan from the first single support on tells where the DCM has to be by then.
  initial_zmp_ = stance_.position;
  plan_reference();
  initial_zmp_ =
      initial_zmp(lqg_.dcm(), stance_.position, plan_.dcm_at_end(0), parameters_.t_init, omega_);
  com_reference_ = lqg_.com();
}

WalkingEngine::StanceError WalkingEngine::stance_error(const Footstep& stance,
                                                       const Footstep& landed) const {
  // Not as far apart as parameters that are still to come would have them.
  const StepPattern& rest = waiting_ ? step_pattern({}, reach_, parameters_) : pattern_;
  const Footstep wanted = next_footstep(stance, rest);
  return {(landed.position - wanted.position).norm(),
          std::abs(std::remainder(landed.yaw - wanted.yaw, 2.0 * std::numbers::pi))};
}

bool WalkingEngine::stands_side_by_side() const {
  // More than a body misses its footholds by.
  constexpr double most_distance = 0.02;  // [m]
  constexpr double most_turn = 0.1;       // [rad]
  const StanceError error = stance_error(stance_, landed_);
  return error.distance < most_distance && error.turn < most_turn;
}

void WalkingEngine::begin_rest(const Vec2& dcm) {
  initial_zmp_ = initial_zmp(dcm, middle(), middle(), parameters_.t_init, omega_);
}

void WalkingEngine::plan_steps(const Footstep& first_stance, std::size_t first) {
  step_count_ = machine_.steps_ahead();
  Footstep from = first_stance;
  for (std::size_t i = first; i < step_count_; ++i) {
    const std::size_t listed = list_next_ + i;
    steps_[i] = listed < list_size_ ? list_[listed] : next_footstep(from, pattern(i));
    from = steps_[i];
  }
}

void WalkingEngine::plan_reference() {
  plan_.clear();
  if (machine_.state() == WalkingState::idle) {
    const double left = std::max(parameters_.t_init - machine_.time(), 0.0);
    const Vec2 way = middle() - initial_zmp_;
    plan_.add({left, middle() - left / parameters_.t_init * way, middle()});
    plan_.add({parameters_.tick, middle(), middle()});
    plan_.solve(middle(), omega_);
    return;
  }

  const bool stands = machine_.ends_standing();
  Footstep from = stance_;
  if (machine_.state() == WalkingState::initialize) {
    const double share = machine_.time() / parameters_.t_init;
    const Vec2 now = initial_zmp_ + share * (stance_.position - initial_zmp_);
    plan_.add({parameters_.t_init - machine_.time(), now, stance_.position});
    plan_.add({pattern(0).times.t_ss, stance_.position, stance_.position});
  } else if (machine_.state() == WalkingState::single_support) {
    plan_.add({machine_.single_support_left(), stance_.position, stance_.position});
  } else {
    const Vec2 goal = step_count_ == 0 ? middle() : landed_.position;
    const double share =
        machine_.t_ds() > 0.0 ? 1.0 - machine_.double_support_left() / machine_.t_ds() : 1.0;
    const Vec2 now = stance_.position + share * (goal - stance_.position);
    plan_.add({machine_.double_support_left(), now, goal});
    if (step_count_ == 0) {
      plan_.solve(goal, omega_);
      return;
    }
    plan_.add({pattern(0).times.t_ss, landed_.position, landed_.position});
    from = landed_;
  }

  for (std::size_t i = 0; i < step_count_; ++i) {
    const Footstep& to = steps_[i];
    const bool last = i + 1 == step_count_;
    if (last && stands) {
      const Vec2 goal = 0.5 * (from.position + to.position);
      plan_.add({parameters_.t_init, from.position, goal});
      plan_.solve(goal, omega_);
      return;
    }
    plan_.add({pattern(i).times.t_ds, from.position, to.position});
    if (!last) plan_.add({pattern(i + 1).times.t_ss, to.position, to.position});
    from = to;
  }
  // Beyond the preview the gait is taken to go on for ever as it is.
  const Footstep next = next_footstep(from, pattern_);
  const Footstep after = next_footstep(next, pattern_);
  plan_.solve(from.position + periodic_dcm_offset(next.position - from.position,
                                                  after.position - next.position,
                                                  pattern_.times.t_ss, pattern_.times.t_ds, omega_),
              omega_);
}

StepSituation WalkingEngine::situation(const Footstep& next) const {
  return {stance_, next, lqg_.dcm(), plan_.dcm_at_end(0), transfer_factor(machine_.t_ds(), omega_)};
}

void WalkingEngine::adjust() {
  const double planned_t_ss = machine_.t_ss();
  // A recovery may begin with a step shorter than that: its place is found in its first tick.
  const bool under_way = machine_.time() > 0.0;
  const double left = machine_.single_support_left();
  if (under_way && left <= 0.0) {
    steps_[0] = late_step();
  } else if (under_way && left <= parameters_.step_freeze && !take_anew()) {
    steps_[0] = swing_goal_;
  } else {
    StepSituation now = situation(planned_);
    // A last step that lets it stand needs no change, however far the DCM is from its reference.
    const bool ends_well = parameters_.strategies.ankle && machine_.last_step() &&
                           recovery_.will_stand(now, machine_.single_support_left(), omega_);
    const double lag = -std::expm1(-parameters_.tick / parameters_.time_constant);
    if (parameters_.strategies.time && !ends_well) adjust_step_time(now, lag);
    if (parameters_.strategies.step && !ends_well) {
      const double rest = machine_.single_support_left();  // by the new time
      lean_on_ankle(now, rest);
      const StepAdjustment adjustment = adjust_step(now, rest, omega_, step_reach(), parameters_);
      steps_[0] = adjustment.step;
      adjusting_ = adjustment.adjusted;
    }
  }
  // The plan has to be of the step that is really taken: then the reference meets the DCM.
  const bool as_planned = steps_[0].position == planned_.position &&
                          steps_[0].yaw == planned_.yaw && machine_.t_ss() == planned_t_ss;
  if (as_planned) return;
  plan_steps(steps_[0], 1);
  plan_reference();
}

Footstep WalkingEngine::late_step() const {
  if (!parameters_.strategies.step) return swing_goal_;
  // As if it landed now: when it will, nobody knows.
  const StepAdjustment now =
      adjust_step(situation(planned_), 0.0, omega_, step_reach(), parameters_);
  return now.adjusted ? Footstep{now.step.position, swing_goal_.yaw, swing_goal_.side}
                      : swing_goal_;
}

bool WalkingEngine::take_anew() {
  const double left = machine_.single_support_left();
  if (!parameters_.strategies.step || !parameters_.strategies.time) return false;
  StepSituation now = situation(planned_);
  lean_on_ankle(now, left);
  const StepAdjustment wanted = adjust_step(now, left, omega_, step_reach(), parameters_);
  const double off = (wanted.step.position - swing_goal_.position).norm();
  if (off <= parameters_.step_anew) return false;
  const double passed = machine_.time();
  const double latest = nominal_t_ss_ + parameters_.time_limit - passed;
  const double needed = swing_time(now, left, latest);
  if (needed <= parameters_.step_freeze) return false;
  machine_.set_t_ss(passed + needed);
  swing_.retarget(landing_pose(swing_goal_), passed, passed + needed);
  swing_.lift(parameters_.swing_height);
  return true;
}

double WalkingEngine::swing_time(const StepSituation& now, double earliest, double latest) const {
  // The later, the farther away is the foothold: each look comes nearer to the time that fits.
  constexpr int looks = 4;
  const FootTarget foot = swing_.at(machine_.time());
  double needed = earliest;
  for (int i = 0; i < looks && needed < latest; ++i) {
    const Footstep to = adjust_step(now, needed, omega_, step_reach(), parameters_).step;
    needed = std::clamp(least_time(to.position - foot.position.head<2>(), foot.velocity.head<2>(),
                                   needed, parameters_.swing_acceleration),
                        earliest, latest);
  }
  return needed;
}

void WalkingEngine::lean_on_ankle(StepSituation& now, double left) const {
  if (!parameters_.strategies.ankle || parameters_.ankle_share == 0.0) return;
  const auto foothold_error = [&](const Vec2& foothold) -> Vec2 {
    return catching_line(now).foothold(std::exp(omega_ * left)) - foothold;
  };
  now.ankle = Vec2::Zero();
  now.ankle = ankle_help(now, foothold_error(now.planned.position), left, omega_, sole_,
                         parameters_.ankle_share);
  // What no step reaches is left to the ankle, too, with all of the sole.
  const Vec2 wanted = now.planned.position + foothold_error(now.planned.position);
  const Vec2 beyond = wanted - step_reach().clamp(now.stance, wanted);
  if (beyond.squaredNorm() > 0.0) now.ankle = ankle_help(now, beyond, left, omega_, sole_, 1.0);
}

void WalkingEngine::adjust_step_time(StepSituation now, double share) {
  const double passed = machine_.time();
  double earliest = std::max({nominal_t_ss_ - parameters_.time_limit, parameters_.least_t_ss,
                              passed + parameters_.step_freeze});
  const double latest = std::max(nominal_t_ss_ + parameters_.time_limit, earliest);
  double nominal = std::clamp(nominal_t_ss_, earliest, latest);
  double wanted = nominal;
  if (parameters_.strategies.step) {
    lean_on_ankle(now, nominal - passed);
    if (adjust_step(now, nominal - passed, omega_, step_reach(), parameters_).adjusted) {
      earliest = passed + swing_time(now, earliest - passed, latest - passed);
      nominal = std::max(nominal, earliest);
      wanted = passed + adjust_time(now, nominal - passed, earliest - passed, latest - passed,
                                    omega_, step_time_reach());  // (12')
    }
  }
  // (13'), about the nominal time: nothing accumulates.
  machine_.set_t_ss(machine_.t_ss() + share * (wanted - machine_.t_ss()));
}

DcmGoal WalkingEngine::goal() const {
  // Between two steps the ZMP can choose which error to leave to the next step: one that it can
  // still make good, whatever the distance from the reference.
  const bool between_steps = machine_.state() == WalkingState::double_support && step_count_ > 0;
  if (!between_steps || !parameters_.strategies.step) return {};
  const double gain = std::expm1(omega_ * machine_.double_support_left());
  if (gain <= 0.0) return {};
  const Vec2 held = plan_.dcm() - (plan_.dcm_at_end(0) - plan_.dcm()) / gain;
  return {&capture_.polygon(landed_.side, parameters_.strategies.time), landed_.position,
          landed_.yaw, 1.0 + gain, held};
}

void WalkingEngine::move_swing_foot() {
  Footstep& goal = steps_[0];
  const double time = machine_.time();
  const double left = machine_.single_support_left();
  if (left <= 0.0) {
    swing_.go_after(goal.position, parameters_.landing_rate, parameters_.tick);
    goal.position = swing_.at(time).position.head<2>();
    swing_goal_ = goal;
    return;
  }
  const std::size_t side = index(goal.side);
  const bool loaded = measured_.foot_load[side] > parameters_.hold_load;
  lifted_ = lifted_ || !loaded;
  if (lifted_ && loaded && !machine_.past_mid_swing()) {
    // What it has caught at holds it by the friction of its own pull.
    swing_.hold(measured_.feet[side], time);
  }
  // A foot that comes to rest in the time left is at its fastest 15/8 of its mean speed.
  const Vec2 here = swing_.at(time).position.head<2>();
  const Vec2 way = goal.position - here;
  const double most = parameters_.swing_speed * left / 1.875;
  if (way.norm() > most) goal.position = here + way * (most / way.norm());
  const FootPose landing = landing_pose(goal);
  const bool lower = landing.position.z() != swing_.landing_height();
  if (goal.position != swing_goal_.position || goal.yaw != swing_goal_.yaw || lower ||
      machine_.t_ss() != swing_.duration()) {
    swing_.retarget(landing, time, machine_.t_ss());
    swing_goal_ = goal;
  }
}

void WalkingEngine::use_hip() {
  if (parameters_.hip.torque <= 0.0) return;
  // Axes of the stance foot.
  const double yaw = stance_.yaw;
  constexpr double far_inside = -1.0;
  std::array<Excess, 2> excess{Excess{far_inside, far_inside}, Excess{far_inside, far_inside}};
  const auto measure = [&](const Vec2& point, const ConvexPolygon& area, const Vec2& origin,
                           double area_yaw, double scale) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (std::size_t v = 0; v < area.size(); ++v) {
        const double x = rotated(area.vertex(v) - origin, -area_yaw)[i];
        low = std::min(low, x);
        high = std::max(high, x);
      }
      const double x = rotated(point - origin, -area_yaw)[i];
      excess[axis] = {(x - high) * scale, (low - x) * scale};
    }
  };
  const bool single = machine_.state() == WalkingState::single_support;
  if (single && parameters_.strategies.step) {
    const double growth = std::exp(omega_ * machine_.single_support_left());
    const StepSituation now = situation(steps_[0]);
    const Vec2 foothold = catching_line(now).foothold(growth);
    const Vec2 local = rotated(foothold - stance_.position, -yaw);
    measure(local, reach_.polygon(stance_.side), Vec2::Zero(), 0.0, now.transfer / growth);
  } else if (single) {
    // The ZMP that takes the DCM to where the plan wants it at touchdown; without a step ahead that
    // is the DCM itself. A step that comes is allowed to be met a little off its plan.
    const double decay = std::exp(-omega_ * machine_.single_support_left());
    const double gain = 1.0 - decay;
    if (gain > 0.0) {
      measure((lqg_.dcm() - decay * plan_.dcm_at_end(0)) / gain, polygon_, stance_.position, yaw,
              gain);
      for (Excess& axis : excess) {
        axis.plus -= decay * parameters_.step_margin;
        axis.minus -= decay * parameters_.step_margin;
      }
    }
  } else if (machine_.state() == WalkingState::idle) {
    measure(lqg_.dcm(), polygon_, stance_.position, yaw, 1.0);
  }
  hip_.update(excess, polygon_.margin(targets_.zmp_command), hip_acts(parameters_));
  hip_aid_ = {rotated(hip_.zmp_shift(), yaw), rotated(hip_.swing(), yaw)};
  targets_.zmp_shift = hip_aid_.shift;
  targets_.hip_angle = hip_.angle();
  targets_.hip_rate = hip_.rate();
  targets_.hip_acceleration =
      hip_.zmp_shift() * (parameters_.mass * parameters_.gravity / parameters_.hip.inertia);
}

FootholdRegion WalkingEngine::reachable_footholds() const {
  if (machine_.state() != WalkingState::single_support) return {};
  return in_world(step_reach().polygon(stance_.side), stance_);
}

FootholdRegion WalkingEngine::foothold_demand() const {
  if (machine_.state() != WalkingState::single_support) return {};
  std::array<Vec2, ConvexPolygon::capacity> zmp{stance_.position};
  std::size_t corners = 1;
  if (parameters_.strategies.ankle) {
    corners = polygon_.size();
    for (std::size_t i = 0; i < corners; ++i) zmp[i] = polygon_.vertex(i);
  }
  const double left = std::max(machine_.single_support_left(), 0.0);
  return capturing_footholds(situation(steps_[0]),
                             {left, machine_.t_ds(), omega_, std::span(zmp).first(corners),
                              &capture_.polygon(other(stance_.side), parameters_.strategies.time)});
}

std::size_t WalkingEngine::swing_path(std::span<Vec3> points) const {
  const double left = machine_.single_support_left();
  if (machine_.state() != WalkingState::single_support || left <= 0.0 || points.size() < 2)
    return 0;
  const double between = left / static_cast<double>(points.size() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = swing_.at(machine_.time() + static_cast<double>(i) * between).position;
  }
  return points.size();
}

void WalkingEngine::publish(const LqgReference& reference) {
  WalkingTargets& t = targets_;
  t.state = machine_.state();
  t.support_side = machine_.support_side();
  t.phase_time = machine_.time();
  t.t_ss = machine_.t_ss();
  const bool single = machine_.state() == WalkingState::single_support;
  t.planned_t_ss = single ? nominal_t_ss_ : machine_.t_ss();
  t.t_ds = machine_.t_ds();
  t.step_count = machine_.landings();
  t.recovering = recovering_;
  t.zmp_reference = reference.zmp;
  t.com_reference = reference.com;
  t.com_velocity_reference = omega_ * (reference.dcm - reference.com);
  t.dcm_reference = reference.dcm;
  t.com_estimate = lqg_.com();
  t.dcm_estimate = lqg_.dcm();
  // Over ground that rises the centre of mass goes along with it, not up with every step.
  constexpr double most_rise = 0.1;  // beyond what a step brings; a fall must not turn it over [m]
  t.com_height = parameters_.com_height +
                 std::clamp(ground_.rise(lqg_.com() - stance_.position), -most_rise, most_rise);
  t.ground_slope = ground_.gradient();
  for (const Side side : {Side::left, Side::right}) {
    FootTarget& foot = t.feet[index(side)];
    foot = FootTarget();
    foot.position = standing_[index(side)].position;
    foot.yaw = standing_[index(side)].yaw;
  }
  if (single) {
    t.feet[index(other(machine_.support_side()))] = swing_.at(machine_.time());
  }
  const FootTarget& left = t.feet[index(Side::left)];
  const FootTarget& right = t.feet[index(Side::right)];
  // Measured yaw angles wrap at pi: only their difference has a meaning.
  t.heading = left.yaw + 0.5 * std::remainder(right.yaw - left.yaw, 2.0 * std::numbers::pi);
  t.heading_velocity = 0.5 * (left.yaw_velocity + right.yaw_velocity);
  t.planned_step = planned_;
  t.adjusted_step = step_count_ > 0 ? steps_[0] : landed_;
  t.preview = steps_;
  t.preview_count = step_count_;
}

}  // namespace stagger::engine
