#include "sim/simulation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "engine/tuning.h"
#include "sim/parameter_table.h"
#include "sim/plant/full_body_plant.h"
#include "sim/plant/lipm_plant.h"

namespace stagger::sim {
namespace {

/// The configuration's parameters. Throws std::invalid_argument when they cannot be.
WorldParameters valid_parameters(const SimulationConfig& config, const ParameterValues& values) {
  if (!config.robot) throw std::invalid_argument("a simulation needs a robot");
  for (const ParameterFault& fault : check_parameters(config, values)) {
    throw std::invalid_argument("parameter " + fault.name + " " + fault.text);
  }
  return world_parameters(config, values);
}

/// The robot as it is to walk.
std::shared_ptr<const Robot> posed(const std::shared_ptr<const Robot>& robot, double com_height) {
  if (robot->description.walk.com_height_m == com_height) return robot;
  auto other = std::make_shared<Robot>(*robot);
  other->description.walk.com_height_m = com_height;
  return other;
}

std::unique_ptr<Plant> make_plant(const SimulationConfig& config, const WorldParameters& p) {
  if (config.plant == PlantKind::lipm) {
    if (config.terrain.kind != TerrainKind::flat) {
      throw std::invalid_argument("the plant lipm walks on flat ground only");
    }
    return std::make_unique<LipmPlant>(p.lipm, Simulation::tick_s);
  }
  TerrainParameters terrain = config.terrain;
  terrain.friction = p.ground_friction;
  return std::make_unique<FullBodyPlant>(posed(config.robot, p.engine.com_height), p.physics,
                                         p.senses, config.seed, Terrain(terrain, config.seed),
                                         p.gains);
}

std::vector<std::string> joint_names(const SimulationConfig& config) {
  // The point mass has no joints to tell of.
  if (config.plant == PlantKind::lipm) return {};
  return config.robot->model.joint_names();
}

GaitPhase gait_phase(const engine::WalkingTargets& t, double heading) {
  GaitPhase phase{t.state, t.support_side, 0.0, heading};
  if (t.state == WalkingState::single_support) {
    phase.fraction = t.phase_time / t.t_ss;
  } else if (t.state == WalkingState::double_support) {
    phase.fraction = (t.phase_time - t.t_ss) / t.t_ds;
  }
  return phase;
}

const char* text_of(engine::WalkingEngine::StepListError error) {
  using Error = engine::WalkingEngine::StepListError;
  switch (error) {
    case Error::none:
      break;
    case Error::walking:
      return "the robot does not stand; stop it first";
    case Error::too_long:
      return "is one more than a list may have";
    case Error::wrong_side:
      return "is with the same foot as the one before";
    case Error::out_of_reach:
      return "is out of the leg's reach from the one before";
    case Error::turns_too_far:
      return "turns the foot too far against the one before";
    case Error::soles_too_near:
      return "brings the soles too near to each other";
  }
  return "";
}

const char* name(Side side) { return side == Side::left ? "left" : "right"; }

}  // namespace

Simulation::Simulation(SimulationConfig config)
    : config_(std::move(config)),
      parameters_(valid_parameters(config_, config_.parameters)),
      active_(config_.parameters),
      plant_(make_plant(config_, parameters_)),
      engine_(parameters_.engine, plant_->measurement()) {
  channels_ = make_channels(joint_names(config_));
  plant_->describe(frame_);
}

void Simulation::walk(const engine::WalkCommand& command) { engine_.walk(command); }

void Simulation::stop_walking() { engine_.stop(); }

void Simulation::set_strategies(const engine::Strategies& strategies) {
  const bool others = !(config_.strategies == strategies);
  config_.strategies = strategies;
  engine_.set_strategies(strategies);
  if (!others) return;
  std::string text = "may act:";
  if (strategies.ankle) text += " ankle";
  if (strategies.hip) text += " hip";
  if (strategies.step) text += " step";
  if (strategies.time) text += " time";
  emit_now(EventKind::strategies, text,
           {{"ankle", strategies.ankle ? 1.0 : 0.0},
            {"hip", strategies.hip ? 1.0 : 0.0},
            {"step", strategies.step ? 1.0 : 0.0},
            {"time", strategies.time ? 1.0 : 0.0}});
}

void Simulation::follow(std::span<const Footstep> steps) {
  using Error = engine::WalkingEngine::StepListError;
  const WorldShift known = frame_.drift.inverse();
  std::vector<Footstep> list;
  for (const Footstep& step : steps) list.push_back(known.applied_to(step));
  std::size_t refused = 0;
  const Error error = engine_.follow(list, &refused);
  if (error == Error::none) return;
  if (error == Error::walking) throw StepListRefused(text_of(error), std::nullopt);
  if (error == Error::too_long) refused = engine::WalkingEngine::max_listed_steps;
  throw StepListRefused(text_of(error), refused);
}

void Simulation::set_parameters(const ParameterValues& values) {
  ParameterValues merged = live_part(values, config_.parameters);
  if (merged == config_.parameters) return;
  WorldParameters parameters = valid_parameters(config_, merged);
  if (!engine_.change(engine::Tuning(parameters.engine))) {
    throw std::logic_error("a parameter that is not of the next step reached a living world");
  }
  config_.parameters = std::move(merged);
  parameters_ = std::move(parameters);
  changing_ = true;
}

void Simulation::note_parameters() {
  plant_->set_gains(parameters_.gains);
  std::string text = "in effect:";
  std::vector<std::pair<std::string, double>> changed;
  const WorldParameters own = default_parameters(config_);
  for (const ParameterInfo& info : parameter_table()) {
    const std::string parameter(info.name);
    const auto value_in = [&](const ParameterValues& values) {
      const auto found = values.find(parameter);
      return found == values.end() ? info.get(own) : found->second;
    };
    const double now = value_in(config_.parameters);
    if (now == value_in(active_)) continue;
    changed.emplace_back(parameter, now);
    text += " " + parameter;
  }
  active_ = config_.parameters;
  changing_ = false;
  // A change that was taken back before it came to its step is none.
  if (!changed.empty()) emit(EventKind::parameters, std::move(text), std::move(changed));
}

std::uint64_t Simulation::push(PushSpec spec) {
  if (spec.link.empty()) spec.link = config_.robot->description.torso;
  if (!config_.robot->model.links.contains(spec.link)) {
    throw std::invalid_argument("robot " + config_.robot->name + " has no link '" + spec.link +
                                "'");
  }
  const std::uint64_t id = pushes_.add(spec, tick_);
  open_pushes_.emplace_back(id - 1, PushState::scheduled);
  return id;
}

bool Simulation::cancel_push(std::uint64_t id) { return pushes_.cancel(id, tick_); }

const Frame& Simulation::step() {
  const bool up = fall_reason_.empty();
  const std::uint64_t landed_before = engine_.targets().step_count;
  const engine::WalkingTargets before = engine_.targets();
  const engine::WalkingTargets& targets =
      up ? engine_.update(plant_->measurement()) : engine_.targets();
  const bool changed = changing_ && !engine_.change_waits();

  frame_.tick = tick_;
  frame_.time = static_cast<double>(tick_) * tick_s;
  plant_->describe(frame_);
  fill_frame(targets);
  if (changed) note_parameters();
  if (up) {
    worst_dcm_error_ = std::max(worst_dcm_error_, (frame_.dcm - frame_.dcm_reference).norm());
    if (targets.step_count != landed_before) note_landing(before);
  }

  const auto& forces = pushes_.forces(tick_, frame_.time, tick_s,
                                      gait_phase(targets, targets.heading + frame_.drift.yaw));
  frame_.push_force.setZero();
  for (const AppliedForce& applied : forces) frame_.push_force += applied.force;
  frame_.push_point = forces.empty() ? frame_.com : plant_->point_of(forces.front());
  note_pushes();

  plant_->step(targets, forces);
  plant_->mix_state(hash_);
  ++tick_;
  if (up) note_fall();
  return frame_;
}

void Simulation::fill_frame(const engine::WalkingTargets& targets) {
  frame_.state = targets.state;
  frame_.support_side = targets.support_side;
  frame_.phase_time = targets.phase_time;
  frame_.t_ss = targets.t_ss;
  frame_.planned_t_ss = targets.planned_t_ss;
  frame_.t_ds = targets.t_ds;
  frame_.step_count = targets.step_count;
  frame_.recovering = targets.recovering;

  const engine::Measurement& sensed = plant_->measurement();
  const std::size_t support = engine::index(targets.support_side);
  frame_.drift = WorldShift::between(sensed.feet[support], frame_.feet[support]);
  const auto here = [this](const auto& thing) { return frame_.drift.applied_to(thing); };
  const double omega = engine::natural_frequency(engine_.parameters());
  frame_.com_sensed = here(sensed.com);
  frame_.dcm_sensed = here(Vec2(sensed.com.head<2>() + sensed.com_velocity.head<2>() / omega));
  frame_.com_reference = here(targets.com_reference);
  frame_.dcm_reference = here(targets.dcm_reference);
  frame_.zmp_reference = here(targets.zmp_reference);
  frame_.dcm_estimate = here(targets.dcm_estimate);
  frame_.zmp_command = here(targets.zmp_command);
  for (std::size_t i = 0; i < 2; ++i) {
    frame_.foot_targets[i] = here(FootPose{targets.feet[i].position, targets.feet[i].yaw});
  }
  frame_.planned_step = here(targets.planned_step);
  frame_.adjusted_step = here(targets.adjusted_step);
  frame_.preview_count = targets.preview_count;
  for (std::size_t i = 0; i < targets.preview_count; ++i) {
    frame_.preview[i] = here(targets.preview[i]);
  }
  const engine::ConvexPolygon& polygon = engine_.support_polygon();
  frame_.support_polygon_count = polygon.size();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    frame_.support_polygon[i] = here(polygon.vertex(i));
  }
  fill_regions();
  frame_.fallen = !fall_reason_.empty();
}

void Simulation::fill_regions() {
  const auto region_here = [this](engine::FootholdRegion region) {
    for (std::size_t i = 0; i < region.count; ++i) {
      region.corners[i] = frame_.drift.applied_to(region.corners[i]);
    }
    return region;
  };
  frame_.reachable_footholds = region_here(engine_.reachable_footholds());
  frame_.capture_region = region_here(engine_.foothold_demand());
  frame_.swing_path_count = engine_.swing_path(frame_.swing_path);
  for (std::size_t i = 0; i < frame_.swing_path_count; ++i) {
    frame_.swing_path[i] = frame_.drift.applied_to(frame_.swing_path[i]);
  }
}

void Simulation::emit(EventKind kind, std::string text,
                      std::vector<std::pair<std::string, double>> values) {
  events_.push_back({frame_.tick, frame_.time, kind, std::move(text), std::move(values)});
}

void Simulation::emit_now(EventKind kind, std::string text,
                          std::vector<std::pair<std::string, double>> values) {
  events_.push_back(
      {tick_, static_cast<double>(tick_) * tick_s, kind, std::move(text), std::move(values)});
}

void Simulation::note_landing(const engine::WalkingTargets& swing) {
  // `swing` is the last tick of the swing that has just ended.
  const Footstep planned = frame_.drift.applied_to(swing.planned_step);
  const Footstep& adjusted = swing.adjusted_step;
  const std::size_t foot = engine::index(planned.side);
  const Vec2 landed = frame_.feet[foot].position.head<2>();
  const double adjustment = (adjusted.position - swing.planned_step.position).norm();
  char text[160];
  std::snprintf(text, sizeof text,
                "%s foot landed at (%.3f, %.3f), %.3f m from where it was planned",
                name(planned.side), landed.x(), landed.y(), (landed - planned.position).norm());
  emit(EventKind::step, text,
       {{"side", static_cast<double>(foot)},
        {"x", landed.x()},
        {"y", landed.y()},
        {"planned_x", planned.position.x()},
        {"planned_y", planned.position.y()},
        {"adjustment", adjustment}});
  note_adjustment(swing, landed);
}

void Simulation::note_adjustment(const engine::WalkingTargets& swing, const Vec2& landed) {
  const double moved = (swing.adjusted_step.position - swing.planned_step.position).norm();
  const double later = swing.t_ss - swing.planned_t_ss;
  if (moved <= told_adjustment_m && std::abs(later) <= told_adjustment_s) return;
  const Footstep planned = frame_.drift.applied_to(swing.planned_step);
  const Footstep adjusted = frame_.drift.applied_to(swing.adjusted_step);
  char text[200];
  std::snprintf(text, sizeof text,
                "%s step moved by %.3f m, from (%.3f, %.3f) to (%.3f, %.3f), and %.3f s %s",
                name(planned.side), moved, planned.position.x(), planned.position.y(),
                adjusted.position.x(), adjusted.position.y(), std::abs(later),
                later < 0.0 ? "sooner" : "later");
  emit(EventKind::adjustment, text,
       {{"side", static_cast<double>(engine::index(planned.side))},
        {"planned_x", planned.position.x()},
        {"planned_y", planned.position.y()},
        {"adjusted_x", adjusted.position.x()},
        {"adjusted_y", adjusted.position.y()},
        {"x", landed.x()},
        {"y", landed.y()},
        {"moved_m", moved},
        {"planned_t_ss", swing.planned_t_ss},
        {"t_ss", swing.t_ss},
        {"recovering", swing.recovering ? 1.0 : 0.0}});
}

void Simulation::note_pushes() {
  const auto& records = pushes_.records();
  for (auto& [i, told] : open_pushes_) {
    const PushRecord& push = records[i];
    if (push.state == told) continue;
    const auto id = static_cast<double>(push.id);
    char text[160];
    const bool started_now = push.start_tick == tick_;
    if (started_now) {
      std::snprintf(text, sizeof text, "push %g on %s: %.3g N s over %g s", id,
                    push.spec.link.c_str(), push.spec.impulse_ns, push.spec.duration_s);
      emit(
          EventKind::push_started, text,
          {{"id", id}, {"impulse_ns", push.spec.impulse_ns}, {"duration_s", push.spec.duration_s}});
    }
    if (push.state == PushState::done) {
      std::snprintf(text, sizeof text, "push %g delivered %.3g N s", id, push.delivered.norm());
      emit(EventKind::push_done, text, {{"id", id}, {"delivered_ns", push.delivered.norm()}});
    } else if (push.state == PushState::cancelled) {
      std::snprintf(text, sizeof text, "push %g cancelled after %.3g N s", id,
                    push.delivered.norm());
      emit(EventKind::push_cancelled, text, {{"id", id}, {"delivered_ns", push.delivered.norm()}});
    }
    told = push.state;
  }
  std::erase_if(open_pushes_, [](const auto& open) {
    return open.second == PushState::done || open.second == PushState::cancelled;
  });
}

void Simulation::note_fall() {
  fall_reason_ = plant_->fall_reason();
  if (fall_reason_.empty()) return;
  plant_->release();
  frame_.fallen = true;
  emit(EventKind::fall, "the robot has fallen: " + fall_reason_);
}

}  // namespace stagger::sim
