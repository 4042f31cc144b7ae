#include "engine/walking_engine.h"

#include <numbers>

#include "engine/footstep_planner.h"

namespace stagger::engine {
namespace {

Footstep footstep(const FootPose& pose, Side side) {
  return {pose.position.head<2>(), pose.yaw, side};
}

}  // namespace

WalkingEngine::WalkingEngine(const Parameters& parameters, const Measurement& start)
    : parameters_(parameters),
      omega_(natural_frequency(parameters)),
      sole_{parameters.foot_half_length - parameters.sole_margin,
            parameters.foot_half_width - parameters.sole_margin},
      machine_(parameters),
      lqg_(parameters),
      standing_(start.feet),
      com_reference_(start.com.head<2>()) {
  stance_ = footstep(start.feet[index(Side::left)], Side::left);
  landed_ = footstep(start.feet[index(Side::right)], Side::right);
  planned_ = landed_;
  swing_goal_ = landed_;
}

void WalkingEngine::walk(const WalkCommand& command) {
  command_ = command;
  machine_.start();
}

void WalkingEngine::stop() {
  command_ = WalkCommand();
  machine_.stop();
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
  inputs.swing_foot_loaded =
      measurement.foot_load[index(swing_side)] > parameters_.contact_load;
  while (true) {
    const Transition transition = machine_.advance(inputs);
    if (transition == Transition::none) break;
    react(transition, measurement);
  }

  const bool single = machine_.state() == WalkingState::single_support;
  plan_steps(machine_.state() == WalkingState::double_support ? landed_ : stance_);
  planned_ = step_count_ > 0 ? steps_[0] : landed_;
  plan_reference();
  adjusting_ = false;
  if (single) {
    adjust();
    move_swing_foot();
    polygon_ = SupportPolygon(sole_, measurement.feet[index(stance_.side)]);
  } else {
    polygon_ = SupportPolygon(sole_, measurement.feet[0], measurement.feet[1]);
  }

  const LqgReference reference{com_reference_, plan_.dcm(), plan_.zmp()};
  publish(reference);
  targets_.zmp_command =
      lqg_.control(reference, polygon_, parameters_.strategies.ankle, !adjusting_);
  com_reference_ = plan_.advance_com(com_reference_, parameters_.tick, omega_);
  machine_.pass(parameters_.tick);
  return targets_;
}

void WalkingEngine::react(Transition transition, const Measurement& measurement) {
  const auto measured = [&](Side side) {
    return footstep(measurement.feet[index(side)], side);
  };
  switch (transition) {
    case Transition::none:
      break;
    case Transition::begin_shift: {
      standing_ = measurement.feet;
      stance_ = measured(machine_.support_side());
      landed_ = measured(other(stance_.side));
      plan_steps(stance_);
      const Vec2 away = steps_[0].position - stance_.position;
      const Vec2 back = steps_[1].position - steps_[0].position;
      const Vec2 offset =
          periodic_dcm_offset(away, back, parameters_.t_ss, parameters_.t_ds, omega_);
      initial_zmp_ = initial_zmp(lqg_.dcm(), stance_.position, stance_.position + offset,
                                 parameters_.t_init, omega_);
      com_reference_ = lqg_.com();
      break;
    }
    case Transition::lift_off: {
      stance_ = measured(machine_.support_side());
      standing_ = measurement.feet;
      plan_steps(stance_);
      swing_goal_ = steps_[0];
      swing_.start(standing_[index(swing_goal_.side)], landing_pose(swing_goal_),
                   machine_.t_ss() - machine_.time(), parameters_.swing_height);
      break;
    }
    case Transition::landing:
      landed_ = measured(other(machine_.support_side()));
      standing_[index(landed_.side)] = measurement.feet[index(landed_.side)];
      break;
    case Transition::stand:
      stance_ = measured(machine_.support_side());
      landed_ = measured(other(stance_.side));
      standing_ = measurement.feet;
      break;
  }
}

void WalkingEngine::plan_steps(const Footstep& first_stance) {
  step_count_ = machine_.steps_ahead();
  const double step_time = parameters_.t_ss + parameters_.t_ds;
  Footstep from = first_stance;
  for (std::size_t i = 0; i < step_count_; ++i) {
    steps_[i] = next_footstep(from, command_, step_time, parameters_);
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
    plan_.add({parameters_.t_ss, stance_.position, stance_.position});
  } else if (machine_.state() == WalkingState::single_support) {
    plan_.add({machine_.single_support_left(), stance_.position, stance_.position});
  } else {
    const Vec2 goal = step_count_ == 0 ? middle() : landed_.position;
    const double share = machine_.t_ds() > 0.0
                             ? 1.0 - machine_.double_support_left() / machine_.t_ds()
                             : 1.0;
    const Vec2 now = stance_.position + share * (goal - stance_.position);
    plan_.add({machine_.double_support_left(), now, goal});
    if (step_count_ == 0) {
      plan_.solve(goal, omega_);
      return;
    }
    plan_.add({parameters_.t_ss, landed_.position, landed_.position});
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
    plan_.add({parameters_.t_ds, from.position, to.position});
    if (!last) plan_.add({parameters_.t_ss, to.position, to.position});
    from = to;
  }
  // Beyond the preview the gait is taken to go on for ever as it is.
  const double step_time = parameters_.t_ss + parameters_.t_ds;
  const Footstep next = next_footstep(from, command_, step_time, parameters_);
  const Footstep after = next_footstep(next, command_, step_time, parameters_);
  plan_.solve(from.position + periodic_dcm_offset(next.position - from.position,
                                                  after.position - next.position, parameters_.t_ss,
                                                  parameters_.t_ds, omega_),
              omega_);
}

void WalkingEngine::adjust() {
  const double left = machine_.single_support_left();
  Footstep goal = swing_goal_;
  if (left > parameters_.step_freeze) {
    goal = steps_[0];
    if (parameters_.strategies.step) {
      const StepSituation situation{stance_,
                                    steps_[0],
                                    lqg_.dcm(),
                                    plan_.dcm_at_end(0),
                                    left,
                                    transfer_factor(parameters_.t_ds, omega_)};
      const StepAdjustment adjustment = adjust_step(situation, omega_, parameters_);
      goal = adjustment.step;
      adjusting_ = adjustment.adjusted;
    }
  }
  // The plan has to be of the step that is really taken: then the reference meets the DCM.
  if (goal.position != steps_[0].position) {
    const double step_time = parameters_.t_ss + parameters_.t_ds;
    steps_[0] = goal;
    for (std::size_t i = 1; i < step_count_; ++i) {
      steps_[i] = next_footstep(steps_[i - 1], command_, step_time, parameters_);
    }
    plan_reference();
  }
}

void WalkingEngine::move_swing_foot() {
  const Footstep& goal = steps_[0];
  if (goal.position != swing_goal_.position || goal.yaw != swing_goal_.yaw) {
    swing_.retarget(landing_pose(goal), machine_.time(), machine_.t_ss());
    swing_goal_ = goal;
  }
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
