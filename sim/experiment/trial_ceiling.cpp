#include "sim/experiment/trial_ceiling.h"

#include <algorithm>
#include <cmath>

#include "engine/footstep_planner.h"
#include "engine/reference.h"
#include "sim/engine_setup.h"
#include "sim/experiment/push_ceiling.h"
#include "sim/simulation.h"

namespace stagger::sim {
namespace {

using engine::ConvexSet;

Vec2 mirror(const Vec2& v) { return {v.x(), -v.y()}; }

/// A robot on two feet can stay so for as long as it likes, then lift either of them: any point
/// between one of the sole's hull and one that is viable at that lift-off.
double standing_ceiling(const PushSpec& push, const engine::StepAbility& ability,
                        const engine::Parameters& p) {
  const Vec2 left(0.0, 0.5 * p.stance_width);
  const ConvexSet soles =
      engine::hull_of(engine::shifted(ability.sole, left), engine::shifted(ability.sole, -left));
  const auto ceiling = [&](const ConvexSet& viable) {
    return delta_v_ceiling(viable, Vec2::Zero(), push.direction.head<2>(), push.duration_s,
                           ability.omega);
  };
  if (!p.strategies.step) return ceiling(soles);
  const ConvexSet on_left = engine::viable_dcm(ability);
  const ConvexSet on_right = engine::mirrored(on_left);
  return std::max(ceiling(engine::hull_of(soles, engine::shifted(on_left, left))),
                  ceiling(engine::hull_of(soles, engine::shifted(on_right, -left))));
}

double walking_ceiling(const PushSpec& push, Side leg, double t_left,
                       const engine::StepAbility& ability, const engine::StepPattern& pattern) {
  const engine::Footstep stance{Vec2::Zero(), 0.0, leg};
  const engine::Footstep next = engine::next_footstep(stance, pattern);
  const engine::Footstep after = engine::next_footstep(next, pattern);
  Vec2 dcm = engine::periodic_dcm_offset(next.position, after.position - next.position,
                                         ability.t_ss, ability.t_ds, ability.omega) *
             std::exp(ability.omega * (ability.t_ss - t_left));
  Vec2 direction = push.direction.head<2>();
  // Abilities are told for the left foot standing.
  if (leg == Side::right) {
    dcm = mirror(dcm);
    direction = mirror(direction);
  }
  const double earliest = std::max(t_left - ability.sooner, 0.0);
  return delta_v_ceiling(engine::viable_dcm(ability, earliest, t_left + ability.later), dcm,
                         direction, push.duration_s, ability.omega);
}

}  // namespace

std::optional<double> trial_ceiling(const TrialSpec& spec, const Robot& robot) {
  if (!spec.push || spec.push->direction.z() != 0.0) return std::nullopt;
  const PushSpec& push = *spec.push;
  if (push.profile != PushProfile::rectangular) return std::nullopt;

  // The margin that the full body's controller keeps inside the sole is its own choice.
  WorldParameters wanted;
  wanted.engine = engine_parameters(robot, PlantKind::lipm, spec.strategies, Simulation::tick_s);
  const double sole_margin = wanted.engine.sole_margin;
  set_values(wanted, spec.parameters);
  wanted.engine.sole_margin = sole_margin;
  const engine::Parameters& p = wanted.engine;
  const engine::ReachRegion reach(p);
  engine::StepAbility ability = engine::step_ability(p, reach, spec.strategies.time);
  if (spec.stand) return standing_ceiling(push, ability, p);

  const auto* phase = std::get_if<PhaseTrigger>(&push.trigger);
  if (phase == nullptr || phase->phase != WalkingState::single_support) return std::nullopt;
  const bool sideways = spec.walk.vy != 0.0;
  if (spec.walk.wz != 0.0 || (sideways && !spec.strategies.step)) return std::nullopt;
  const engine::StepPattern pattern = engine::step_pattern(spec.walk, reach, p);
  ability.t_ss = pattern.times.t_ss;
  ability.t_ds = pattern.times.t_ds;
  if (!spec.strategies.step) ability.reach = {pattern.offset[engine::index(Side::left)]};
  const double t_left = (1.0 - phase->fraction) * ability.t_ss;
  const auto ceiling = [&](Side leg) {
    return walking_ceiling(push, leg, t_left, ability, pattern);
  };
  if (phase->leg) return ceiling(*phase->leg);
  return std::max(ceiling(Side::left), ceiling(Side::right));
}

}  // namespace stagger::sim
