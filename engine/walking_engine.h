// The one door of the engine: a measurement goes in, targets come out.
#pragma once

#include "engine/lqg.h"
#include "engine/measurement.h"
#include "engine/parameters.h"
#include "engine/reference.h"
#include "engine/state_machine.h"
#include "engine/step_adjuster.h"
#include "engine/support_polygon.h"
#include "engine/swing.h"
#include "engine/walking_targets.h"

namespace stagger::engine {

/// The walking engine of Kasaei, Lau and Pereira (IROS 2019). Knows no clock: call update() once a
/// control period. After construction it takes no memory, throws nothing and locks nothing.
class WalkingEngine {
 public:
  /// Stands on the feet of `start`. Throws std::invalid_argument when the parameters have no
  /// stabilising controller.
  WalkingEngine(const Parameters& parameters, const Measurement& start);

  /// Starts walking or changes the velocity in mid-walk; the step under way lands as planned.
  void walk(const WalkCommand& command);
  /// Takes one more whole step and comes to rest on both feet.
  void stop();
  void set_strategies(const Strategies& strategies) { parameters_.strategies = strategies; }

  /// One control period.
  const WalkingTargets& update(const Measurement& measurement);

  const WalkingTargets& targets() const { return targets_; }
  const Parameters& parameters() const { return parameters_; }
  const SupportPolygon& support_polygon() const { return polygon_; }
  const StateMachine& state_machine() const { return machine_; }
  const Lqg& lqg() const { return lqg_; }

 private:
  void react(Transition transition, const Measurement& measurement);
  void plan_steps(const Footstep& first_stance);
  void plan_reference();
  void adjust();
  void move_swing_foot();
  void publish(const LqgReference& reference);

  FootPose landing_pose(const Footstep& step) const;
  Vec2 middle() const;

  Parameters parameters_;
  double omega_;
  Sole sole_;
  StateMachine machine_;
  Lqg lqg_;
  WalkCommand command_;

  Footstep stance_;               ///< f_i; in double support the foot that the ZMP leaves
  Footstep landed_;               ///< in double support: f_{i+1}, where the foot really landed
  PerFoot<FootPose> standing_{};  ///< where each foot stands, or stood before it lifted off
  Footstep planned_;              ///< next foothold before adjustment
  std::array<Footstep, preview_steps> steps_;
  std::size_t step_count_ = 0;
  SwingTrajectory swing_;
  Footstep swing_goal_;           ///< what swing_ is heading for
  bool adjusting_ = false;

  DcmPlan plan_;
  SupportPolygon polygon_;
  Vec2 com_reference_ = Vec2::Zero();
  Vec2 initial_zmp_ = Vec2::Zero();  ///< of Initialize
  WalkingTargets targets_;
};

}  // namespace stagger::engine
