// One trial: settle, push, observe. A pure function from its specification to its result.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/parameters.h"
#include "sim/control/senses.h"
#include "sim/plant/plant.h"
#include "sim/plant/push.h"
#include "sim/plant/terrain.h"
#include "sim/robot/robot.h"
#include "sim/world_parameters.h"

namespace stagger::sim {

struct TrialSpec {
  std::string robot;  ///< required
  PlantKind plant = PlantKind::bullet;
  std::uint64_t seed = 1;
  engine::WalkCommand walk;
  bool stand = false;  ///< no walk command: it stands, is pushed, and is to stand again
  engine::Strategies strategies;
  SenseParameters senses;  ///< of the full body
  TerrainParameters terrain;
  bool self_collision = true;  ///< of the full body
  double settle_s = 3.0;       ///< walking or standing before the push may start [s]
  double observe_s = 4.0;      ///< after the push has ended [s]
  std::optional<PushSpec> push;
  /// In place of `push`: one after another. One with a time comes at that time; any other waits for
  /// its trigger from the end of the one before it in the list.
  std::vector<PushSpec> pushes;
  ParameterValues parameters;  ///< that are to differ from the robot's own
};

/// What became of one push of a list.
struct PushOutcome {
  std::optional<std::uint64_t> start_tick;
  std::optional<std::uint64_t> end_tick;
  double delivered_ns = 0.0;  ///< norm of the impulse that really acted [N s]
  /// As those of TrialResult, by the next push's start at the latest.
  std::optional<std::uint64_t> steps_to_recover;
  std::optional<double> recovery_time_s;
  /// The robot fell during or after this push, before the next one.
  bool fell = false;
};

enum class TrialOutcome : std::uint8_t {
  recovered,  ///< still up when the observation ended
  fell,       ///< fell during or after the push
  timeout,    ///< the push never started, or never ended
  invalid     ///< fell before the push started: says nothing about the push
};

struct TrialResult {
  TrialOutcome outcome = TrialOutcome::invalid;
  std::string reason;         ///< of a fall, a time-out or an invalid trial; else empty
  double delivered_ns = 0.0;  ///< norm of the impulse that really acted [N s]
  std::optional<std::uint64_t> push_tick;         ///< first tick of the push
  std::optional<std::uint64_t> steps_to_recover;  ///< steps until back at the commanded gait
  /// From the push's end until back for good at what was commanded, by the criteria of recovery.h
  /// [s]; 0: it was by then. Nothing when it had not come back by the end of the observation.
  std::optional<double> recovery_time_s;
  std::optional<double> fall_time_s;
  std::vector<PushOutcome> pushes;  ///< of a list, in its order
  double worst_dcm_error_m = 0.0;
  std::uint64_t ticks = 0;
  std::uint64_t state_hash = 0;
};

/// Runs in a world built afresh, so that the same specification gives the same result to the bit.
TrialResult run_trial(const TrialSpec& spec, std::shared_ptr<const Robot> robot);

}  // namespace stagger::sim
