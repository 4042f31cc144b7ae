// A point mass with feet that go where they are told, under the engine; integrated on its own.
#pragma once

#include <algorithm>

#include "engine/walking_engine.h"
#include "tests/engine/integrate.h"

namespace stagger::testing {

using engine::Measurement;
using engine::natural_frequency;
using engine::Parameters;
using engine::Vec2;
using engine::WalkingEngine;
using engine::WalkingState;
using engine::WalkingTargets;

/// A gait of half a second a step, without noise.
inline Parameters quick() {
  Parameters p;
  p.tick = 0.001;
  p.t_ss = 0.4;
  p.t_ds = 0.1;
  p.t_init = 0.6;
  p.measurement_noise = 1e-8;
  p.step_margin = 0.01;
  return p;
}

class Walk {
 public:
  /// At rest, the CoM at `com`; the middle between the feet is the origin.
  explicit Walk(const Parameters& parameters = quick(), const Vec2& com = Vec2::Zero())
      : parameters_(parameters),
        omega_(natural_frequency(parameters)),
        mass_{com, Vec2::Zero()},
        engine_(parameters, start()) {}

  void run(double seconds) {
    const int ticks = static_cast<int>(std::lround(seconds / parameters_.tick));
    for (int i = 0; i < ticks; ++i) tick();
  }
  /// What the sensors make of each measurement before the engine sees it.
  void set_sensors(std::function<void(Measurement&)> sensors) { sensors_ = std::move(sensors); }
  void push(const Vec2& velocity) { mass_.velocity += velocity; }
  /// A foot that stands slips [m].
  void slip(engine::Side side, const Vec2& way) {
    measurement_.feet[engine::index(side)].position.head<2>() += way;
  }

  WalkingEngine& engine() { return engine_; }
  const WalkingEngine& engine() const { return engine_; }
  Vec2 dcm() const { return mass_.dcm(omega_); }
  Vec2 com() const { return mass_.com; }
  Vec2 velocity() const { return mass_.velocity; }
  double worst_error() const { return worst_error_; }
  double worst_velocity_jump() const { return worst_velocity_jump_; }
  const Measurement& measurement() const { return measurement_; }
  Vec2 middle() const {
    return 0.5 * (measurement_.feet[0].position + measurement_.feet[1].position).head<2>();
  }
  void forget() { worst_error_ = worst_velocity_jump_ = 0.0; }

 private:
  Measurement start() {
    measurement_.com << mass_.com, parameters_.com_height;
    measurement_.feet[0].position = {0.0, 0.5 * parameters_.stance_width, 0.0};
    measurement_.feet[1].position = {0.0, -0.5 * parameters_.stance_width, 0.0};
    return measurement_;
  }

  void tick() {
    measurement_.com.head<2>() = mass_.com;
    measurement_.com_velocity.head<2>() = mass_.velocity;
    Measurement seen = measurement_;
    if (sensors_) sensors_(seen);
    const WalkingTargets& t = engine_.update(seen);
    worst_error_ = std::max(worst_error_, (dcm() - t.dcm_reference).norm());
    const Vec2 jump = t.com_velocity_reference - last_velocity_;
    worst_velocity_jump_ = std::max(worst_velocity_jump_, jump.norm());
    last_velocity_ = t.com_velocity_reference;
    const Vec2 zmp = t.zmp_command;
    mass_ = integrate(
        mass_, [&](double) { return zmp; }, parameters_.tick, omega_, 1);
    for (std::size_t i = 0; i < 2; ++i) {
      if (!t.feet[i].in_contact) measurement_.feet[i] = {t.feet[i].position, t.feet[i].yaw};
      measurement_.foot_load[i] = measurement_.feet[i].position.z() <= 0.0 ? 150.0 : 0.0;
    }
  }

  Parameters parameters_;
  double omega_;
  PointMass mass_;
  Measurement measurement_;
  WalkingEngine engine_;
  std::function<void(Measurement&)> sensors_;
  Vec2 last_velocity_ = Vec2::Zero();
  double worst_error_ = 0.0;
  double worst_velocity_jump_ = 0.0;
};

}  // namespace stagger::testing
