#include "engine/walking_engine.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "engine/footstep_planner.h"

namespace stagger::engine {
namespace {

Footstep footstep(const FootPose& pose, Side side) {
  return {pose.position.head<2>(), pose.yaw, side};
}

}  // namespace

WalkingEngine::WalkingEngine(const Parameters& parameters, const Measurement& start, Layout)
    : WalkingEngine(parameters, start, ReachRegion(parameters)) {}

WalkingEngine::WalkingEngine(const Parameters& parameters, const Measurement& start,
                             const ReachRegion& reach, Layout)
    : parameters_(parameters),
      omega_(natural_frequency(parameters)),
      sole_{parameters.foot_half_length - parameters.sole_margin,
            parameters.foot_half_width - parameters.sole_margin},
      reach_(reach),
      time_reach_(reach.scaled_length(parameters.time_reach)),
      capture_(parameters, reach),
      machine_(parameters),
      lqg_(parameters),
      hip_(parameters.hip, parameters.mass * parameters.gravity, omega_, parameters.tick),
      times_(step_times({}, parameters)),
      standing_(start.feet) {
  stance_ = footstep(start.feet[index(Side::left)], Side::left);
  landed_ = footstep(start.feet[index(Side::right)], Side::right);
  planned_ = landed_;
  swing_goal_ = landed_;
  com_reference_ = middle();
  polygon_ = engine::support_polygon(sole_, start.feet[0], start.feet[1]);
}

void WalkingEngine::walk(const WalkCommand& command) {
  command_ = command;
  times_ = step_times(command, parameters_);
  machine_.set_times(times_);
  machine_.start();
  list_size_ = list_next_ = 0;
}

void WalkingEngine::stop() {
  command_ = WalkCommand();
  times_ = step_times(command_, parameters_);
  machine_.set_times(times_);
  machine_.stop();
  list_size_ = list_next_ = 0;
}

WalkingEngine::StepListError WalkingEngine::follow(std::span<const Footstep> steps) {
  if (machine_.state() != WalkingState::idle) return StepListError::walking;
  if (steps.size() > max_listed_steps) return StepListError::too_long;
  if (steps.empty()) return StepListError::none;
  // The first step starts from the other foot, wherever that stands now.
  Footstep from = stance_.side == steps[0].side ? landed_ : stance_;
  for (const Footstep& step : steps) {
    if (step.side == from.side) return StepListError::wrong_side;
    if ((reach_.clamp(from, step.position) - step.position).norm() > 1e-9) {
      return StepListError::out_of_reach;
    }
    from = step;
  }
  std::copy(steps.begin(), steps.end(), list_.begin());
  list_size_ = steps.size();
  list_next_ = 0;
  command_ = WalkCommand();
  times_ = step_times(command_, parameters_);
  machine_.set_times(times_);
  machine_.set_support_side(other(steps[0].side));
  machine_.start(steps.size());
  return StepListError::none;
}

Vec2 WalkingEngine::middle() const { return 0.5 * (stance_.position + landed_.position); }

FootPose WalkingEngine::landing_pose(const Footstep& step) const {
  // The ground is taken to be as high as under the stance foot.
  const double ground = standing_[index(stance_.side)].position.z();
  return {Vec3(step.position.x(), step.position.y(), ground), step.yaw};
}

const WalkingTargets& WalkingEngine::update(const Measurement& measurement) {
  const Vec2 com = measurement.com.head<2>();
  lqg_.estimate(com, com + measurement.com_velocity.head<2>() / omega_);

  const Side swing_side = other(machine_.support_side());
  StateInputs inputs;
  inputs.swing_foot_loaded = measurement.foot_load[index(swing_side)] > parameters_.contact_load;
  while (true) {
    const Transition transition = machine_.advance(inputs);
    if (transition == Transition::none) break;
    react(transition, measurement);
  }

  const bool single = machine_.state() == WalkingState::single_support;
  plan_steps(machine_.state() == WalkingState::double_support ? landed_ : stance_, 0);
  planned_ = step_count_ > 0 ? steps_[0] : landed_;
  plan_reference();
  adjusting_ = false;
  if (single) {
    polygon_ = engine::support_polygon(sole_, measurement.feet[index(stance_.side)]);
    adjust();
    move_swing_foot();
  } else {
    polygon_ = engine::support_polygon(sole_, measurement.feet[0], measurement.feet[1]);
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

void WalkingEngine::react(Transition transition, const Measurement& measurement) {
  const auto measured = [&](Side side) { return footstep(measurement.feet[index(side)], side); };
  switch (transition) {
    case Transition::none:
      break;
    case Transition::begin_shift:
      standing_ = measurement.feet;
      stance_ = measured(machine_.support_side());
      landed_ = measured(other(stance_.side));
      begin_shift();
      break;
    case Transition::lift_off:
      stance_ = measured(machine_.support_side());
      standing_ = measurement.feet;
      nominal_t_ss_ = machine_.t_ss();
      plan_steps(stance_, 0);
      swing_goal_ = steps_[0];
      swing_.start(standing_[index(swing_goal_.side)], landing_pose(swing_goal_),
                   machine_.t_ss() - machine_.time(), parameters_.swing_height);
      break;
    case Transition::landing:
      landed_ = measured(other(machine_.support_side()));
      standing_[index(landed_.side)] = measurement.feet[index(landed_.side)];
      if (list_next_ < list_size_) ++list_next_;
      break;
    case Transition::stand:
      stance_ = measured(machine_.support_side());
      landed_ = measured(other(stance_.side));
      standing_ = measurement.feet;
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

Footstep WalkingEngine::step_after(const Footstep& stance) const {
  return next_footstep(stance, command_, times_.step(), parameters_.stance_width, reach_);
}

void WalkingEngine::plan_steps(const Footstep& first_stance, std::size_t first) {
  step_count_ = machine_.steps_ahead();
  Footstep from = first_stance;
  for (std::size_t i = first; i < step_count_; ++i) {
    const std::size_t listed = list_next_ + i;
    steps_[i] = listed < list_size_ ? list_[listed] : step_after(from);
    from = steps_[i];
  }
}

void WalkingEngine::plan_reference() {
  plan_.clear();
  if (machine_.state() == WalkingState::idle) {
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
    plan_.add({times_.t_ss, stance_.position, stance_.position});
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
    plan_.add({times_.t_ss, landed_.position, landed_.position});
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
    plan_.add({times_.t_ds, from.position, to.position});
    if (!last) plan_.add({times_.t_ss, to.position, to.position});
    from = to;
  }
  // Beyond the preview the gait is taken to go on for ever as it is.
  const Footstep next = step_after(from);
  const Footstep after = step_after(next);
  plan_.solve(from.position + periodic_dcm_offset(next.position - from.position,
                                                  after.position - next.position, times_.t_ss,
                                                  times_.t_ds, omega_),
              omega_);
}

StepSituation WalkingEngine::situation(const Footstep& next) const {
  return {stance_, next, lqg_.dcm(), plan_.dcm_at_end(0), transfer_factor(machine_.t_ds(), omega_)};
}

void WalkingEngine::adjust() {
  if (machine_.single_support_left() <= parameters_.step_freeze) {
    steps_[0] = swing_goal_;
  } else {
    StepSituation now = situation(planned_);
    if (parameters_.strategies.time) adjust_step_time(now);
    if (parameters_.strategies.step) {
      const double left = machine_.single_support_left();
      lean_on_ankle(now, left);
      const StepAdjustment adjustment = adjust_step(now, left, omega_, reach_, parameters_);
      steps_[0] = adjustment.step;
      adjusting_ = adjustment.adjusted;
    }
  }
  // The plan has to be of the step that is really taken: then the reference meets the DCM.
  plan_steps(steps_[0], 1);
  plan_reference();
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
  const Vec2 beyond = wanted - reach_.clamp(now.stance, wanted);
  if (beyond.squaredNorm() > 0.0) now.ankle = ankle_help(now, beyond, left, omega_, sole_, 1.0);
}

void WalkingEngine::adjust_step_time(StepSituation now) {
  const double passed = machine_.time();
  const double earliest = std::max({nominal_t_ss_ - parameters_.time_limit, parameters_.least_t_ss,
                                    passed + parameters_.step_freeze});
  const double latest = std::max(nominal_t_ss_ + parameters_.time_limit, earliest);
  const double nominal = std::clamp(nominal_t_ss_, earliest, latest);
  double wanted = nominal;
  if (parameters_.strategies.step) {
    lean_on_ankle(now, nominal - passed);
    if (adjust_step(now, nominal - passed, omega_, reach_, parameters_).adjusted) {
      wanted = passed + adjust_time(now, nominal - passed, earliest - passed, latest - passed,
                                    omega_, time_reach_);  // (12')
    }
  }
  // (13'), about the nominal time: nothing accumulates.
  const double share = -std::expm1(-parameters_.tick / parameters_.time_constant);
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
  return {&capture_.polygon(landed_.side), landed_.position, landed_.yaw, 1.0 + gain, held};
}

void WalkingEngine::move_swing_foot() {
  Footstep& goal = steps_[0];
  const double time = machine_.time();
  const double left = machine_.single_support_left();
  // A foot that comes to rest in the time left is at its fastest 15/8 of its mean speed.
  const Vec2 here = swing_.at(time).position.head<2>();
  const Vec2 way = goal.position - here;
  const double most = parameters_.swing_speed * left / 1.875;
  if (way.norm() > most) goal.position = here + way * (most / way.norm());
  if (goal.position != swing_goal_.position || goal.yaw != swing_goal_.yaw ||
      machine_.t_ss() != swing_.duration()) {
    swing_.retarget(landing_pose(goal), time, machine_.t_ss());
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
  } else if (single || machine_.state() == WalkingState::idle) {
    measure(lqg_.dcm(), polygon_, stance_.position, yaw, 1.0);
  }
  hip_.update(excess, polygon_.margin(targets_.zmp_command), parameters_.strategies.hip);
  hip_aid_ = {rotated(hip_.zmp_shift(), yaw), rotated(hip_.swing(), yaw)};
  targets_.zmp_shift = hip_aid_.shift;
  targets_.hip_angle = hip_.angle();
}

void WalkingEngine::publish(const LqgReference& reference) {
  WalkingTargets& t = targets_;
  t.state = machine_.state();
  t.support_side = machine_.support_side();
  t.phase_time = machine_.time();
  t.t_ss = machine_.t_ss();
  t.t_ds = machine_.t_ds();
  t.step_count = machine_.landings();
  t.zmp_reference = reference.zmp;
  t.com_reference = reference.com;
  t.com_velocity_reference = omega_ * (reference.dcm - reference.com);
  t.dcm_reference = reference.dcm;
  t.com_estimate = lqg_.com();
  t.dcm_estimate = lqg_.dcm();
  t.com_height = parameters_.com_height;
  for (const Side side : {Side::left, Side::right}) {
    FootTarget& foot = t.feet[index(side)];
    foot = FootTarget();
    foot.position = standing_[index(side)].position;
    foot.yaw = standing_[index(side)].yaw;
  }
  if (machine_.state() == WalkingState::single_support) {
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
