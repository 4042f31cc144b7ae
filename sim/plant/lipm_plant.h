// The paper's plant: a point mass on a massless leg, both axes, with a flywheel for the upper body
// and the feet of the engine's plan.
#pragma once

#include <vector>

#include "engine/lipm.h"
#include "engine/parameters.h"
#include "engine/support_polygon.h"
#include "sim/noise.h"
#include "sim/plant/plant.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

/// The plant's own truth: it may differ from what the engine believes.
struct LipmParameters {
  double mass = 30.0;       ///< [kg]
  double com_height = 1.0;  ///< [m]
  double gravity = 9.81;    ///< [m/s^2]
  engine::Sole sole{0.075, 0.0375};
  double stance_width = 0.2;  ///< of the feet at the start [m]
  double reach = 2.0;         ///< a DCM farther than this from both feet is a fall [m]
  engine::HipParameters hip;  ///< limits of the flywheel; without torque there is none
  double noise = 0.0;         ///< standard deviation of the measured CoM and DCM, each axis [m]
  double delay = 0.0;         ///< age of the measurement [s]
  std::uint64_t seed = 1;     ///< of the noise
};

LipmParameters lipm_parameters(const Robot& robot);

/// x'' = w^2 (x - p) + F / m, exact over a tick. Feet go where they are told and carry no mass. All
/// pushes act on the centre of mass; a vertical part has no effect. Falls by divergence of the DCM.
class LipmPlant final : public Plant {
 public:
  LipmPlant(const LipmParameters& parameters, double dt);

  const engine::Measurement& measurement() const override { return measurement_; }
  void step(const engine::WalkingTargets& targets, std::span<const AppliedForce> forces) override;
  void release() override { released_ = true; }
  void describe(Frame& frame) const override;
  Vec3 point_of(const AppliedForce&) const override { return truth_.com; }
  std::string fall_reason() const override;
  void mix_state(StateHash& hash) const override;

  /// Starts from this CoM position and velocity instead of from rest in the middle.
  void set_state(const Vec2& com, const Vec2& velocity);

  Vec2 dcm() const;  ///< true [m]
  const engine::Measurement& truth() const { return truth_; }
  const Vec2& hip_angle() const { return hip_angle_; }  ///< [rad]

 private:
  void measure();
  Vec2 turn_flywheel(const Vec2& wanted_shift);

  LipmParameters parameters_;
  double omega_;
  double dt_;
  engine::DiscreteLipm lipm_;
  engine::Measurement truth_;
  engine::Measurement measurement_;
  std::vector<engine::Measurement> delayed_;  ///< ring of the last measurements
  std::size_t oldest_ = 0;
  Noise noise_;
  Vec2 hip_angle_ = Vec2::Zero();
  Vec2 hip_rate_ = Vec2::Zero();
  Vec2 hip_shift_ = Vec2::Zero();  ///< of the ZMP by the hips, in the last tick [m]
  bool released_ = false;          ///< a point mass that has fallen would only run away
};

}  // namespace stagger::sim
