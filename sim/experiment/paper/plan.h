// The paper's example of its planners: six steps on a diagonal, checked against what the
// differential equation of the pendulum says.
#pragma once

#include "engine/walking_targets.h"
#include "sim/experiment/paper/trace.h"

namespace stagger::sim {

struct PlanNode {
  double time = 0.0;             ///< [s]
  double com = 0.0;              ///< one axis, both are equal [m]
  double dcm = 0.0;              ///< [m]
  double independent_com = 0.0;  ///< of the boundary value problem, solved as a linear system [m]
};

struct SwingSample {
  double time = 0.0;                             ///< [s]
  engine::Vec3 position = engine::Vec3::Zero();  ///< [m]
};

struct PlanResult {
  /// CoM velocity before and after each boundary of single and double support, each from its own
  /// segment's closed form [m/s].
  double max_velocity_jump = 0.0;
  /// Against the node values of an independent solution of the boundary value problem [m].
  double max_node_error = 0.0;
  /// CoM and DCM against a numerical integration of the differential equation in each segment [m].
  double max_ode_residual = 0.0;
  /// A start from rest: offset of the first ZMP that removes the jump of velocity, and what jump is
  /// left [m, m/s].
  double start_zmp_offset = 0.0;
  double start_velocity = 0.0;
  std::vector<PlanNode> nodes;          ///< at the boundaries
  std::vector<engine::Footstep> steps;  ///< footprints, the first one included
  Trace references;                     ///< references only
  std::vector<std::vector<SwingSample>> swings;
};

PlanResult run_plan();

}  // namespace stagger::sim
