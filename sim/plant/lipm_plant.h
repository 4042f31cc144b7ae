// The paper's plant: a point mass on a massless leg, both axes, with the feet of the engine's plan.
#pragma once

#include "engine/lipm.h"
#include "engine/support_polygon.h"
#include "sim/plant/plant.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

/// x'' = w^2 (x - p) + F / m, exact over a tick. Feet go where they are told and carry no mass. All
/// pushes act on the centre of mass; a vertical part has no effect. Falls by divergence of the DCM.
class LipmPlant final : public Plant {
 public:
  LipmPlant(const Robot& robot, double dt);

  const engine::Measurement& measurement() const override { return measurement_; }
  void step(const engine::WalkingTargets& targets, std::span<const AppliedForce> forces) override;
  void release() override { released_ = true; }
  void describe(Frame& frame) const override;
  Vec3 point_of(const AppliedForce&) const override { return measurement_.com; }
  std::string fall_reason() const override;
  void mix_state(StateHash& hash) const override;

 private:
  double mass_;
  double gravity_ = 9.81;
  double omega_;
  double reach_;
  double dt_;
  engine::Sole sole_;
  engine::DiscreteLipm lipm_;
  engine::Measurement measurement_;
  Side support_ = Side::left;
  bool released_ = false;  ///< a point mass that has fallen would only run away
};

}  // namespace stagger::sim
