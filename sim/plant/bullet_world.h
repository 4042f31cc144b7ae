// The physics alone: a floating-base biped on the ground in Bullet; torques in, state out.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/plant/push.h"
#include "sim/plant/terrain.h"
#include "sim/robot/robot_model.h"
#include "sim/state_hash.h"

namespace stagger::sim {

struct PhysicsParameters {
  double dt = 0.001;           ///< one step [s]
  double gravity = 9.81;       ///< [m/s^2]
  double friction = 0.8;       ///< Coulomb coefficient between robot and ground
  int iterations = 20;         ///< of the constraint solver
  bool self_collision = true;  ///< bodies of the robot may touch each other (body_pairs.h)
};

/// Deterministic: worlds built from the same arguments and stepped with the same inputs agree to
/// the bit, in one process or in two. There is no reset: build a new world.
class BulletWorld {
 public:
  /// A point where the ground, or another of its own bodies, pushes a body of the robot.
  struct Contact {
    static constexpr int ground = -1;
    int body = 0;
    Vec3 point = Vec3::Zero();  ///< on the body's surface, world, where the step began [m]
    Vec3 force = Vec3::Zero();  ///< on the body, mean over the step, world [N]
    int other = ground;  ///< who pushes: the ground, or the body that gets the opposite force
    bool with_ground() const { return other == ground; }
  };

  /// `start` must have one q and qd for each joint. Bodies that touch each other in it, whose
  /// shapes belong together then, never collide.
  BulletWorld(const RobotModel& model, const RobotState& start, const PhysicsParameters& parameters,
              const Terrain& terrain = Terrain({}));
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;
  ~BulletWorld();

  /// Advances by dt. `torque` (one a joint [N m]) is cut to what the motors can give
  /// (motor_limits.h); the forces act during this step at points that are fixed to their links. The
  /// links must exist: whoever accepts a push checks that.
  void step(const Eigen::VectorXd& torque, std::span<const AppliedForce> forces);

  const RobotState& state() const;
  /// What the motors really gave in the last step [N m].
  const Eigen::VectorXd& applied_torque() const;
  /// Of the last step, with the ground and between bodies; only points that carry load.
  std::span<const Contact> contacts() const;
  /// Did the ground push this body in the last step?
  bool touches_ground(int body) const;
  /// World position now of a force's point of application [m].
  Vec3 application_point(const AppliedForce& force) const;
  const PhysicsParameters& parameters() const;

  /// Mixes every bit of the state.
  void mix_state(StateHash& hash) const;

 private:
  struct Impl;  // keeps Bullet's headers away from everybody else
  std::unique_ptr<Impl> impl_;
};

}  // namespace stagger::sim
