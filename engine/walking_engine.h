// The one door of the engine: a measurement goes in, targets come out.
#pragma once

#include <span>

#include "engine/capture_region.h"
#include "engine/hip_strategy.h"
#include "engine/lqg.h"
#include "engine/measurement.h"
#include "engine/parameters.h"
#include "engine/reach.h"
#include "engine/reference.h"
#include "engine/state_machine.h"
#include "engine/step_adjuster.h"
#include "engine/support_polygon.h"
#include "engine/swing.h"
#include "engine/walking_targets.h"

namespace stagger::engine {

/// Where the compiler may place a fixed-size matrix depends on the instruction set that it compiles
/// for (-march), and with it the layout of the engine. As a parameter of the constructors this
/// keeps a program from linking a library of another layout; it would run, on shifted fields.
template <std::size_t Bytes>
struct MatrixAlignment {};
using Layout = MatrixAlignment<EIGEN_MAX_STATIC_ALIGN_BYTES>;

/// The walking engine of Kasaei, Lau and Pereira (IROS 2019). Knows no clock: call update() once a
/// control period. After construction it takes no memory, throws nothing and locks nothing.
class WalkingEngine {
 public:
  /// Why a list of steps was not taken.
  enum class StepListError : std::uint8_t {
    none,
    walking,       ///< a list starts from standing
    too_long,      ///< more than max_listed_steps
    wrong_side,    ///< the sides do not alternate
    out_of_reach,  ///< a step that the leg cannot take from the one before
  };
  static constexpr std::size_t max_listed_steps = 64;

  /// Stands on the feet of `start`. Throws std::invalid_argument when the parameters have no
  /// stabilising controller.
  WalkingEngine(const Parameters& parameters, const Measurement& start, Layout layout = {});
  /// The same with a region of footholds of one's own, e.g. from the leg's kinematics.
  WalkingEngine(const Parameters& parameters, const Measurement& start, const ReachRegion& reach,
                Layout layout = {});

  /// Starts walking or changes the velocity in mid-walk; the step under way lands as planned.
  void walk(const WalkCommand& command);
  /// Takes these steps, in world coordinates, and stands on the last two. Takes all or none.
  StepListError follow(std::span<const Footstep> steps);
  /// Takes one more whole step and comes to rest on both feet.
  void stop();
  void set_strategies(const Strategies& strategies) { parameters_.strategies = strategies; }

  /// One control period.
  const WalkingTargets& update(const Measurement& measurement);

  const WalkingTargets& targets() const { return targets_; }
  const Parameters& parameters() const { return parameters_; }
  const ConvexPolygon& support_polygon() const { return polygon_; }
  const StateMachine& state_machine() const { return machine_; }
  const ReachRegion& reach() const { return reach_; }
  const CaptureRegion& capture_region() const { return capture_; }
  const Lqg& lqg() const { return lqg_; }

 private:
  void react(Transition transition, const Measurement& measurement);
  void begin_shift();
  Footstep step_after(const Footstep& stance) const;
  void plan_steps(const Footstep& first_stance, std::size_t first);
  void plan_reference();
  void adjust();
  void adjust_step_time(StepSituation now);
  /// Fills in the ankle's part of the catch, `left` before touchdown [s].
  void lean_on_ankle(StepSituation& now, double left) const;
  /// `next` is the foothold that plan_ has been made for.
  StepSituation situation(const Footstep& next) const;
  DcmGoal goal() const;
  void move_swing_foot();
  void use_hip();
  void publish(const LqgReference& reference);

  FootPose landing_pose(const Footstep& step) const;
  Vec2 middle() const;

  Parameters parameters_;
  double omega_;
  Sole sole_;
  ReachRegion reach_;
  ReachRegion time_reach_;  ///< what the step time is adjusted for
  CaptureRegion capture_;
  StateMachine machine_;
  Lqg lqg_;
  HipStrategy hip_;
  HipAid hip_aid_;
  WalkCommand command_;
  StepTimes times_;  ///< nominal, of the steps to come
  std::array<Footstep, max_listed_steps> list_;
  std::size_t list_size_ = 0;
  std::size_t list_next_ = 0;  ///< the step that is under way or comes next

  Footstep stance_;               ///< f_i; in double support the foot that the ZMP leaves
  Footstep landed_;               ///< in double support: f_{i+1}, where the foot really landed
  PerFoot<FootPose> standing_{};  ///< where each foot stands, or stood before it lifted off
  Footstep planned_;              ///< next foothold before adjustment
  std::array<Footstep, preview_steps> steps_;
  std::size_t step_count_ = 0;
  SwingTrajectory swing_;
  Footstep swing_goal_;        ///< what swing_ is heading for
  double nominal_t_ss_ = 0.0;  ///< of the single support under way, before adjustment [s]
  bool adjusting_ = false;

  DcmPlan plan_;
  ConvexPolygon polygon_;
  Vec2 com_reference_ = Vec2::Zero();
  Vec2 initial_zmp_ = Vec2::Zero();  ///< of Initialize
  WalkingTargets targets_;
};

}  // namespace stagger::engine
