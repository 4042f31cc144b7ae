#include "sim/simulation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "sim/engine_setup.h"
#include "sim/plant/full_body_plant.h"
#include "sim/plant/lipm_plant.h"

namespace stagger::sim {
namespace {

std::unique_ptr<Plant> make_plant(const SimulationConfig& config) {
  if (!config.robot) throw std::invalid_argument("a simulation needs a robot");
  if (config.plant == PlantKind::lipm) {
    if (config.terrain.kind != TerrainKind::flat) {
      throw std::invalid_argument("the plant lipm walks on flat ground only");
    }
    return std::make_unique<LipmPlant>(lipm_parameters(*config.robot), Simulation::tick_s);
  }
  PhysicsParameters physics = config.physics;
  physics.dt = Simulation::tick_s;
  return std::make_unique<FullBodyPlant>(config.robot, physics, config.senses, config.seed,
                                         Terrain(config.terrain, config.seed));
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

const char* name(Side side) { return side == Side::left ? "left" : "right"; }

}  // namespace

Simulation::Simulation(SimulationConfig config)
    : config_(std::move(config)),
      plant_(make_plant(config_)),
      engine_(engine_parameters(*config_.robot, config_.plant, config_.strategies, tick_s,
                                config_.senses),
              plant_->measurement()) {
  channels_ = make_channels(joint_names(config_));
  plant_->describe(frame_);
}

void Simulation::walk(const engine::WalkCommand& command) { engine_.walk(command); }

void Simulation::stop_walking() { engine_.stop(); }

void Simulation::set_strategies(const engine::Strategies& strategies) {
  config_.strategies = strategies;
  engine_.set_strategies(strategies);
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

  frame_.tick = tick_;
  frame_.time = static_cast<double>(tick_) * tick_s;
  plant_->describe(frame_);
  fill_frame(targets);
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
  frame_.fallen = !fall_reason_.empty();
}

void Simulation::emit(EventKind kind, std::string text,
                      std::vector<std::pair<std::string, double>> values) {
  events_.push_back({frame_.tick, frame_.time, kind, std::move(text), std::move(values)});
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
