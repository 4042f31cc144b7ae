// Our step adjuster beside the quadratic programme of Khadiv et al., "Walking control based on step
// timing adaptation" (IEEE T-RO 2020): both decide place and time of one step in the same
// situations, and both walk on from there in the same way.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/experiment/peers/capture_set.h"

namespace stagger::sim {

/// Where and when the next foot touches down.
struct StepDecision {
  engine::Vec2 step = engine::Vec2::Zero();  ///< from the stance foot [m]
  double touchdown = 0.0;                    ///< since the last touchdown [s]
};

/// A point mass in mid-step, the stance foot in the origin.
struct StepTimingCase {
  std::string robot;
  PointWalker walker;
  engine::Side stance = engine::Side::left;
  double elapsed = 0.0;   ///< since the last touchdown [s]
  double earliest = 0.0;  ///< touchdown, since the last one: limits and a swing foot in the air [s]
  double nominal = 0.0;   ///< touchdown when nothing disturbs [s]
  engine::Vec2 nominal_step = engine::Vec2::Zero();    ///< that gives the wanted velocity [m]
  engine::Vec2 nominal_offset = engine::Vec2::Zero();  ///< of the DCM from the foot, after it [m]
  engine::Vec2 dcm = engine::Vec2::Zero();             ///< [m]
  StepDecision qp{};                                   ///< what the quadratic programme decided
  bool qp_slack = false;                               ///< and could only by softening its limits
};

/// Throws std::runtime_error when the file cannot be read.
std::vector<StepTimingCase> read_step_timing(const std::string& file);

/// Our decision: adjust_time() and adjust_step() of the engine within the case's limits.
StepDecision our_decision(const StepTimingCase& situation);
/// The same decided anew every `tick` [s] as the DCM runs on, and kept from when the swing foot may
/// no longer be hurried.
StepDecision our_decision_in_closed_loop(const StepTimingCase& situation, double tick);
/// DCM from the new stance foot right after the touchdown [m].
engine::Vec2 offset_after(const StepTimingCase& situation, const StepDecision& decision);

/// One way of deciding, over many cases.
struct StepTimingScore {
  std::size_t captured = 0;
  double least_reserve = 0.0;     ///< the DCM jump right after touchdown that is still caught [m]
  double mean_reserve = 0.0;      ///< the same [m]
  double offset_error_rms = 0.0;  ///< DCM after touchdown from its nominal offset [m]
  double mean_time_change = 0.0;  ///< |touchdown - nominal| [s]
};

/// The cases with the DCM so many times as far from the stance foot: no quadratic programme decided
/// these, but nobody can do better than the set.
struct StepTimingStress {
  double scale = 1.0;
  std::size_t catchable = 0;  ///< by anyone
  std::size_t ours = 0;       ///< captured by our adjuster
};

/// All cases of one robot.
struct StepTimingComparison {
  std::string robot;
  std::size_t cases = 0;
  std::size_t catchable = 0;  ///< by anyone: the infinite-step set
  std::size_t qp_slack = 0;   ///< cases in which the quadratic programme softened its limits
  std::size_t qp_captured_without_slack = 0;
  StepTimingScore qp;
  StepTimingScore ours;
  StepTimingScore closed_loop;         ///< ours, deciding every millisecond
  std::size_t both = 0;                ///< captured by ours and by the quadratic programme
  std::size_t both_without_slack = 0;  ///< the same where that kept its limits
  std::size_t ours_nearer = 0;    ///< cases with the DCM nearer to nominal after our step by 1 mm
  std::size_t qp_nearer = 0;      ///< the other way round
  std::size_t decisions = 0;      ///< judged by simulation and by the set, stress included
  std::size_t disagreements = 0;  ///< of these two
  double step_difference = 0.0;   ///< greatest, between deciding once and every millisecond [m]
  double time_difference = 0.0;   ///< greatest, between deciding once and every millisecond [s]
  std::vector<StepTimingStress> stress;
};

/// One comparison a robot, in the order in which they come up.
std::vector<StepTimingComparison> compare_step_timing(std::span<const StepTimingCase> cases);

}  // namespace stagger::sim
