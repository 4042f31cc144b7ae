// The one door of the engine: a measurement goes in, targets come out.
#pragma once

#include <optional>
#include <span>

#include "engine/capture_region.h"
#include "engine/footholds.h"
#include "engine/footstep_planner.h"
#include "engine/ground_slope.h"
#include "engine/hip_strategy.h"
#include "engine/lqg.h"
#include "engine/measurement.h"
#include "engine/parameters.h"
#include "engine/reach.h"
#include "engine/recovery.h"
#include "engine/reference.h"
#include "engine/state_machine.h"
#include "engine/step_adjuster.h"
#include "engine/support_polygon.h"
#include "engine/swing.h"
#include "engine/tuning.h"
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
    walking,         ///< a list starts from standing
    too_long,        ///< more than max_listed_steps
    wrong_side,      ///< the sides do not alternate
    out_of_reach,    ///< a step that the leg cannot take from the one before
    turns_too_far,   ///< a step turned by more than max_step_turn against the one before
    soles_too_near,  ///< a step that overlaps the one before or is within foot_clearance of it
  };
  static constexpr std::size_t max_listed_steps = 64;

  /// Stands on the feet of `start`. Throws std::invalid_argument when the parameters are not valid
  /// (see validate()) or have no stabilising controller, and when `start` is not usable.
  WalkingEngine(const Parameters& parameters, const Measurement& start, Layout layout = {});
  /// The same with a region of footholds of one's own, e.g. from the leg's kinematics.
  WalkingEngine(const Parameters& parameters, const Measurement& start, const ReachRegion& reach,
                Layout layout = {});

  /// Starts walking or changes the velocity, cut to the limits as step_pattern() tells. In mid-walk
  /// the step under way and the one after it are taken as planned: the CoM is already on its way to
  /// them, and would have to jump for others. In double support that is the step that comes next.
  void walk(const WalkCommand& command);
  /// Takes these steps, in world coordinates, and stands on the last two. Takes all or none; the
  /// one that is not taken is told in `refused`, where somebody wants to know.
  StepListError follow(std::span<const Footstep> steps, std::size_t* refused = nullptr);
  /// Comes to rest on both feet, side by side: one more whole step; one more than that from the
  /// second half of a swing on, and again when the last one had to be adjusted.
  void stop();
  void set_strategies(const Strategies& strategies) { parameters_.strategies = strategies; }

  /// Goes over to other parameters, but for the strategies, which stay as they are. At rest it does
  /// so at once. In mid-walk the steps that walk() would keep are taken as planned, and the others
  /// in the new gait: all of the parameters change together, where the first of those lifts off. A
  /// list of steps is walked to its end as it was accepted. A newer change replaces one that waits.
  /// False, and nothing has changed, when they are of another body: see same_body().
  [[nodiscard]] bool change(const Tuning& tuning);
  /// A change waits for its step.
  bool change_waits() const { return waiting_.has_value(); }

  /// One control period. A measurement that cannot be (a NaN, an infinity, anything beyond 1e6)
  /// is not used: without CoM or its velocity the filter only predicts, and feet and loads count as
  /// they were last seen.
  const WalkingTargets& update(const Measurement& measurement);

  const WalkingTargets& targets() const { return targets_; }
  /// Velocity of the steps to come: the command of walk(), cut to the limits.
  const WalkCommand& command() const { return pattern_.command; }
  const Parameters& parameters() const { return parameters_; }
  const ConvexPolygon& support_polygon() const { return polygon_; }
  const StateMachine& state_machine() const { return machine_; }
  const ReachRegion& reach() const { return reach_; }
  const CaptureRegion& capture_region() const { return capture_; }
  const Lqg& lqg() const { return lqg_; }

  // For whoever shows what the engine does: asked for, not part of the tick.
  /// Where the leg can put the foot down that is in the air; empty while none is.
  FootholdRegion reachable_footholds() const;
  /// Where that foot has to land, at the time that is planned now, for a fall to be avoidable.
  FootholdRegion foothold_demand() const;
  /// The way that it has before it, from here to touchdown in equal times [m]; writes as many
  /// points as there is room for, or none while no foot is in the air. Returns how many.
  std::size_t swing_path(std::span<Vec3> points) const;

 private:
  struct StanceError {
    double distance;  ///< [m]
    double turn;      ///< [rad]
  };

  bool take(const Measurement& measurement);
  /// The ground is where the stance foot was lowest since the other one left.
  void settle_stance_foot();
  /// Steps when the robot stands and the DCM is lost otherwise.
  void recover();
  /// Steps when it has stood for a while on feet that are not where they should be.
  void mend_stance();
  void react(Transition transition);
  /// How far the foot that landed is from beside the other one, as a pattern at rest has it.
  StanceError stance_error(const Footstep& stance, const Footstep& landed) const;
  bool stands_side_by_side() const;
  void begin_shift();
  /// From this DCM to one over the middle of the feet [m].
  void begin_rest(const Vec2& dcm);
  void set_pattern(const WalkCommand& command, std::size_t kept);
  /// Coming landings that a new command leaves as they are planned.
  std::size_t committed_steps() const;
  /// Goes over to the parameters that wait.
  void retune();
  /// Pattern of the i-th landing from now.
  const StepPattern& pattern(std::size_t i) const { return i < 2 ? coming_[i] : pattern_; }
  void plan_steps(const Footstep& first_stance, std::size_t first);
  void plan_reference();
  void adjust();
  /// In the part of the swing in which steps stay as they are: whether this one must not, since it
  /// lands far from where it would catch the DCM. It then has as much time left as it needs.
  bool take_anew();
  /// Time left that the swing foot needs for the step that is right by then, in that range [s].
  double swing_time(const StepSituation& now, double earliest, double latest) const;
  /// Goes `share` of the way to the time that the step should take.
  void adjust_step_time(StepSituation now, double share);
  /// Fills in the ankle's part of the catch, `left` before touchdown [s].
  void lean_on_ankle(StepSituation& now, double left) const;
  /// `next` is the foothold that plan_ has been made for.
  StepSituation situation(const Footstep& next) const;
  DcmGoal goal() const;
  /// Of the step under way.
  const ReachRegion& step_reach() const { return recovering_ ? recovery_.reach() : reach_; }
  const ReachRegion& step_time_reach() const {
    return recovering_ ? recovery_.time_reach() : time_reach_;
  }
  Footstep late_step() const;
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
  Recovery recovery_;
  StateMachine machine_;
  Lqg lqg_;
  HipStrategy hip_;
  HipAid hip_aid_;
  std::optional<Tuning> waiting_;        ///< the change to come
  std::size_t steps_before_change_ = 0;  ///< landings still to come with the present parameters
  WalkCommand wish_;                     ///< the command, before it is cut to the limits
  StepPattern pattern_;                  ///< of the present command
  std::array<StepPattern, 2> coming_;    ///< of the next two landings, some still of an older one
  std::array<Footstep, max_listed_steps> list_;
  std::size_t list_size_ = 0;
  std::size_t list_next_ = 0;  ///< the step that is under way or comes next

  Measurement measured_;  ///< the newest that was usable, part by part
  bool estimating_ = false;

  bool recovering_ = false;
  bool stands_as_told_ = true;  ///< by whoever started it, or by a list: that stance is kept
  int corrections_left_ = 0;    ///< further steps that a walk may take to end side by side

  Footstep stance_;               ///< f_i; in double support the foot that the ZMP leaves
  Footstep landed_;               ///< in double support: f_{i+1}, where the foot really landed
  PerFoot<FootPose> standing_{};  ///< where each foot stands, or stood before it lifted off
  GroundSlope ground_;
  Footstep planned_;  ///< next foothold before adjustment
  std::array<Footstep, preview_steps> steps_;
  std::size_t step_count_ = 0;
  SwingTrajectory swing_;
  Footstep swing_goal_;        ///< what swing_ is heading for
  double nominal_t_ss_ = 0.0;  ///< of the single support under way, before adjustment [s]
  bool lifted_ = false;        ///< the swing foot has carried next to nothing since lift-off
  bool adjusting_ = false;

  DcmPlan plan_;
  ConvexPolygon polygon_;
  Vec2 com_reference_ = Vec2::Zero();
  Vec2 initial_zmp_ = Vec2::Zero();  ///< of Initialize, and of the way back to the middle in idle
  WalkingTargets targets_;
};

}  // namespace stagger::engine
