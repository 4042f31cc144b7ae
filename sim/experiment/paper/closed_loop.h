// The engine on the pendulum: one tick after the other, with what the paper's figures show.
#pragma once

#include <functional>

#include "engine/walking_engine.h"
#include "sim/experiment/paper/trace.h"
#include "sim/plant/lipm_plant.h"

namespace stagger::sim {

/// The paper's robot (its table I), as the engine believes it to be: 500 Hz, and a Kalman filter
/// that knows the standard deviation of the noise on the measured CoM and DCM [m].
engine::Parameters paper_parameters(double noise = 0.0);
/// What the robot really is, beside what the engine believes.
struct ModelError {
  double mass = 1.0;        ///< true / believed
  double com_height = 1.0;  ///< true / believed
  double delay = 0.0;       ///< age of the measurement [s]
};

/// The same robot as it is.
LipmParameters paper_plant(double noise = 0.0, std::uint64_t seed = 1,
                           const ModelError& error = {});

/// Standard deviation of the paper's measurement noise: N(0, 6.25e-4), read as a variance [m].
inline constexpr double paper_noise = 0.025;

class ClosedLoop {
 public:
  ClosedLoop(const engine::Parameters& parameters, const LipmParameters& truth)
      : plant_(truth, parameters.tick),
        engine_(parameters, plant_.measurement()),
        tick_(parameters.tick) {}
  /// Starts from this CoM position and velocity instead of from rest in the middle.
  ClosedLoop(const engine::Parameters& parameters, const LipmParameters& truth,
             const engine::Vec2& com, const engine::Vec2& velocity)
      : ClosedLoop(parameters, truth) {
    plant_.set_state(com, velocity);
  }

  /// Decides, and lets the plant move on under a force on its CoM [N].
  const engine::WalkingTargets& tick(const engine::Vec2& force = engine::Vec2::Zero()) {
    return tick([&force](const engine::WalkingTargets&) { return force; });
  }
  /// The same with a force that depends on what was decided.
  const engine::WalkingTargets& tick(
      const std::function<engine::Vec2(const engine::WalkingTargets&)>& force);
  /// The tick that was last decided, the plant as it was then.
  const TraceSample& sample() const { return sample_; }

  engine::WalkingEngine& engine() { return engine_; }
  LipmPlant& plant() { return plant_; }
  double time() const { return static_cast<double>(ticks_) * tick_; }  ///< [s]

 private:
  LipmPlant plant_;
  engine::WalkingEngine engine_;
  double tick_;
  std::uint64_t ticks_ = 0;
  TraceSample sample_;
};

}  // namespace stagger::sim
