// The full biped: Bullet, its state, and the whole-body controller that turns targets into torques.
#pragma once

#include <memory>

#include "sim/control/whole_body_controller.h"
#include "sim/plant/bullet_world.h"
#include "sim/plant/plant.h"
#include "sim/robot/rigid_body.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

/// State is read from the physics without error: there is no estimator yet.
class FullBodyPlant final : public Plant {
 public:
  /// Stands on the terrain at rest.
  FullBodyPlant(std::shared_ptr<const Robot> robot, const PhysicsParameters& physics,
                const Terrain& terrain = Terrain({}));

  const engine::Measurement& measurement() const override { return measurement_; }
  void step(const engine::WalkingTargets& targets, std::span<const AppliedForce> forces) override;
  void release() override { released_ = true; }
  void describe(Frame& frame) const override;
  Vec3 point_of(const AppliedForce& force) const override;
  std::string fall_reason() const override;
  void mix_state(StateHash& hash) const override;

  const WholeBodyController& controller() const { return controller_; }

 private:
  void measure();

  std::shared_ptr<const Robot> robot_;
  Terrain terrain_;
  BulletWorld world_;
  RigidBody body_;
  WholeBodyController controller_;
  engine::Measurement measurement_;
  Eigen::VectorXd torque_;
  bool released_ = false;
};

}  // namespace stagger::sim
