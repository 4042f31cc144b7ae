// The full biped: Bullet, its state, and the whole-body controller that turns targets into torques.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sim/control/estimator.h"
#include "sim/control/senses.h"
#include "sim/control/sensors.h"
#include "sim/control/whole_body_controller.h"
#include "sim/plant/bullet_world.h"
#include "sim/plant/plant.h"
#include "sim/robot/rigid_body.h"
#include "sim/robot/robot.h"

namespace stagger::sim {

/// Control sees the estimate of the state, or the state itself where the senses are perfect.
class FullBodyPlant final : public Plant {
 public:
  /// Stands on the terrain at rest. The seed is that of the sensors. Gains that are left out are
  /// the robot's own. Throws std::invalid_argument for senses that are not valid.
  FullBodyPlant(std::shared_ptr<const Robot> robot, const PhysicsParameters& physics,
                const SenseParameters& senses, std::uint64_t seed,
                const Terrain& terrain = Terrain({}),
                const std::optional<WholeBodyGains>& gains = {});

  const engine::Measurement& measurement() const override { return measurement_; }
  void step(const engine::WalkingTargets& targets, std::span<const AppliedForce> forces) override;
  void set_gains(const WholeBodyGains& gains) override { controller_.set_gains(gains); }
  void release() override { released_ = true; }
  void describe(Frame& frame) const override;
  Vec3 point_of(const AppliedForce& force) const override;
  std::string fall_reason() const override;
  void mix_state(StateHash& hash) const override;

  const WholeBodyController& controller() const { return controller_; }
  const Estimator& estimator() const { return estimator_; }

 private:
  const RobotState& known_state() const {
    return senses_.perfect_state ? world_.state() : estimator_.state();
  }
  const RigidBody& true_body() const { return senses_.perfect_state ? body_ : true_body_; }
  void sense();
  void place_robot(const RigidBody& body, engine::Measurement& measurement) const;
  void read_loads();
  const Eigen::VectorXd& delayed(const Eigen::VectorXd& torque);

  std::shared_ptr<const Robot> robot_;
  SenseParameters senses_;
  Terrain terrain_;
  BulletWorld world_;
  Sensors sensors_;
  Estimator estimator_;
  RigidBody body_;       ///< as control knows it
  RigidBody true_body_;  ///< kept up where control does not know it
  WholeBodyController controller_;
  engine::Measurement measurement_;
  engine::Measurement truth_;
  PerFoot<SoleLoad> sole_loads_;              ///< true
  std::vector<Eigen::VectorXd> torque_ring_;  ///< on their way to the motors
  std::size_t next_torque_ = 0;
  bool commanded_ = false;
  Eigen::VectorXd torque_;
  double limp_damping_;  ///< [N m s]
  bool released_ = false;
};

}  // namespace stagger::sim
