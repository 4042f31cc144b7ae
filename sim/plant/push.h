// A push as an exact object: what is asked for, when it starts, and what was really delivered.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/types.h"

namespace stagger::sim {

using engine::Side;
using engine::Vec2;
using engine::Vec3;

/// Force over time: constant, or half a sine wave (peak = pi/2 of the constant force of same
/// impulse).
enum class PushProfile : std::uint8_t { rectangular, half_sine };

/// Starts when the gait comes to this phase: `leg` is the support foot (in double support the foot
/// that the ZMP leaves), `fraction` of the phase's duration has passed.
struct PhaseTrigger {
  engine::WalkingState phase = engine::WalkingState::single_support;
  std::optional<Side> leg;  ///< either leg when empty
  double fraction = 0.0;    ///< in [0, 1)
};

/// Starts at the first tick whose simulation time is not before this [s].
struct TimeTrigger {
  double at_s = 0.0;
};

/// Starts at the next tick.
struct Immediate {};

using PushTrigger = std::variant<Immediate, TimeTrigger, PhaseTrigger>;

struct PushSpec {
  std::string link;           ///< empty: the torso that the robot's description names
  std::optional<Vec3> point;  ///< in the link's frame [m]; the link's centre of mass when empty
  Vec3 direction = Vec3::UnitX();  ///< unit vector in the frame of the robot's heading
  double impulse_ns = 0.0;         ///< integral of the force over the whole push [N s]
  double duration_s = 0.1;
  PushProfile profile = PushProfile::rectangular;
  PushTrigger trigger;
};

/// Unit vector of the ground plane: 0 degrees is forward, 90 to the left.
Vec3 horizontal_direction(double degrees);

enum class PushState : std::uint8_t { scheduled, active, done, cancelled };

/// A push on its way: the specification and what has become of it.
struct PushRecord {
  std::uint64_t id = 0;
  PushSpec spec;
  PushState state = PushState::scheduled;
  std::uint64_t created_tick = 0;  ///< first tick that it could have started at
  std::optional<std::uint64_t> start_tick;
  std::optional<std::uint64_t> end_tick;
  Vec3 delivered = Vec3::Zero();  ///< integral of the force that acted so far, world frame [N s]
  Vec3 world_direction = Vec3::Zero();  ///< fixed when it starts: the heading may turn under a push
  bool armed = false;  ///< a phase trigger has seen another phase: it waits for the next time
};

/// A force that acts during one tick, world frame.
struct AppliedForce {
  std::string link;
  std::optional<Vec3> point;  ///< in the link's frame [m]; the link's centre of mass when empty
  Vec3 force = Vec3::Zero();  ///< [N]
};

/// What the schedule needs to know of the gait to start phase-triggered pushes.
struct GaitPhase {
  engine::WalkingState state = engine::WalkingState::idle;
  Side support_side = Side::left;
  double fraction = 0.0;  ///< of the present single or double support
  double heading = 0.0;   ///< [rad]
};

/// All pushes of one simulation, in the order in which they were asked for.
class PushSchedule {
 public:
  /// Returns the new push's id (1, 2, ...). The specification has been validated before.
  std::uint64_t add(const PushSpec& spec, std::uint64_t tick);
  /// False when there is no such push or it is done or cancelled already.
  bool cancel(std::uint64_t id, std::uint64_t tick);
  /// Starts what is due and returns the forces that act during [time, time + dt).
  const std::vector<AppliedForce>& forces(std::uint64_t tick, double time, double dt,
                                          const GaitPhase& phase);
  const std::vector<PushRecord>& records() const { return records_; }

 private:
  std::vector<PushRecord> records_;
  std::vector<std::size_t>
      open_;  ///< indices of those scheduled or active: a tick looks at no other
  std::vector<AppliedForce> acting_;
};

}  // namespace stagger::sim
