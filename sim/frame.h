// One record a tick: all that a viewer, a logger or a report may want to know.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "engine/footholds.h"
#include "engine/types.h"
#include "engine/walking_targets.h"
#include "sim/world_shift.h"

namespace stagger::sim {

using engine::FootPose;
using engine::Footstep;
using engine::PerFoot;
using engine::Side;
using engine::Vec2;
using engine::Vec3;
using engine::WalkingState;

inline constexpr std::size_t max_joints = 64;
inline constexpr std::size_t max_polygon_vertices = 8;
inline constexpr std::size_t swing_path_points = 12;
inline constexpr std::size_t max_contacts = 16;

/// A force that the ground exerts on the robot, world frame.
struct GroundForce {
  Vec3 point = Vec3::Zero();  ///< [m]
  Vec3 force = Vec3::Zero();  ///< [N]
};

/// World frame, SI units; "measured" is what the plant did, "reference" what the engine planned,
/// "sensed" what control knows of it. The world that control knows drifts: what comes from there is
/// told in the true world, as it is to the support foot.
/// Which of these are published, and under which names, is told by the table in channels.h.
struct Frame {
  std::uint64_t tick = 0;
  double time = 0.0;

  WalkingState state = WalkingState::idle;
  Side support_side = Side::left;
  double phase_time = 0.0;
  double t_ss = 0.0;
  double planned_t_ss = 0.0;
  double t_ds = 0.0;
  std::uint64_t step_count = 0;
  bool recovering = false;

  Vec3 com = Vec3::Zero();
  Vec3 com_velocity = Vec3::Zero();
  Vec2 dcm = Vec2::Zero();
  Vec2 zmp = Vec2::Zero();
  Vec3 angular_momentum = Vec3::Zero();  ///< about the centre of mass [N m s]
  Vec3 com_sensed = Vec3::Zero();
  Vec2 dcm_sensed = Vec2::Zero();
  WorldShift drift;  ///< of the world that control knows; undone in all of this frame
  Vec2 com_reference = Vec2::Zero();
  Vec2 dcm_reference = Vec2::Zero();
  Vec2 zmp_reference = Vec2::Zero();
  Vec2 dcm_estimate = Vec2::Zero();
  Vec2 zmp_command = Vec2::Zero();

  Vec3 base_position = Vec3::Zero();
  Eigen::Quaterniond base_orientation = Eigen::Quaterniond::Identity();
  PerFoot<FootPose> feet;
  PerFoot<FootPose> foot_targets;
  PerFoot<double> foot_load{};

  std::size_t joint_count = 0;  ///< of the robot; 0 on the LIPM
  std::array<double, max_joints> joint_position{};
  std::array<double, max_joints> joint_velocity{};
  std::array<double, max_joints> joint_torque{};

  Footstep planned_step;
  Footstep adjusted_step;
  std::array<Footstep, engine::preview_steps> preview;
  std::size_t preview_count = 0;
  std::array<Vec2, max_polygon_vertices> support_polygon;
  std::size_t support_polygon_count = 0;
  engine::FootholdRegion reachable_footholds;
  engine::FootholdRegion capture_region;
  std::array<Vec3, swing_path_points> swing_path;
  std::size_t swing_path_count = 0;
  std::array<GroundForce, max_contacts> ground_forces;
  std::size_t ground_force_count = 0;

  Vec3 push_force = Vec3::Zero();  ///< sum of the pushes that act now
  Vec3 push_point = Vec3::Zero();  ///< where the first of them acts; the CoM when none does
  bool fallen = false;
};

}  // namespace stagger::sim
