#include "sim/channels.h"

#include <algorithm>

namespace stagger::sim {
namespace {

using Values = std::vector<double>;

std::vector<Component> components(std::initializer_list<const char*> names, const char* unit) {
  std::vector<Component> list;
  list.reserve(names.size());
  for (const char* name : names) list.push_back({name, unit});
  return list;
}

/// A channel of one number.
template <typename Member>
Channel scalar(const char* name, const char* unit, const char* meaning, Member Frame::*member) {
  return {name,
          "",
          meaning,
          {{"value", unit}},
          1,
          [member](const Frame& f, Values& out) {
            out.push_back(static_cast<double>(f.*member)); }};
}

/// A channel of a vector in the world frame.
template <int N>
Channel vector(const char* name, const char* unit, const char* meaning,
               Eigen::Matrix<double, N, 1> Frame::*member) {
  auto labels = N == 2 ? components({"x", "y"}, unit) : components({"x", "y", "z"}, unit);
  return {name, "world", meaning, std::move(labels), 1, [member](const Frame& f, Values& out) {
            const auto& v = f.*member;
            out.insert(out.end(), v.data(), v.data() + N);
          }};
}

Channel foot(const char* name, const char* meaning, PerFoot<FootPose> Frame::*member, Side side) {
  return {
      name,
      "world",
      meaning,
      {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"yaw", "rad"}},
      1,
      [member, side](const Frame& f, Values& out) {
        const FootPose& pose = (f.*member)[engine::index(side)];
        out.insert(out.end(), {pose.position.x(), pose.position.y(), pose.position.z(), pose.yaw});
      }};
}

const std::vector<Component> footstep_components{
    {"x", "m"}, {"y", "m"}, {"yaw", "rad"}, {"side", "1"}};

Channel region(const char* name, const char* meaning, engine::FootholdRegion Frame::*member) {
  return {name,
          "world",
          meaning,
          components({"x", "y"}, "m"),
          engine::FootholdRegion::capacity,
          [member](const Frame& f, Values& out) {
            for (const Vec2& corner : (f.*member).view()) {
              out.insert(out.end(), {corner.x(), corner.y()});
            }
          }};
}

void append(const Footstep& step, Values& out) {
  out.insert(out.end(), {step.position.x(), step.position.y(), step.yaw,
                         static_cast<double>(engine::index(step.side))});
}

Channel footstep(const char* name, const char* meaning, Footstep Frame::*member) {
  return {name,    "world",
          meaning, footstep_components,
          1,       [member](const Frame& f, Values& out) { append(f.*member, out); }};
}

Channel joints(const char* name, const char* unit, const char* meaning,
               const std::vector<std::string>& names,
               std::array<double, max_joints> Frame::*member) {
  std::vector<Component> labels;
  labels.reserve(names.size());
  for (const std::string& joint : names) labels.push_back({joint, unit});
  return {name, "joint", meaning, std::move(labels), 1, [member](const Frame& f, Values& out) {
            const auto& values = f.*member;
            out.insert(out.end(), values.begin(),
                       values.begin() + static_cast<std::ptrdiff_t>(f.joint_count));
          }};
}

}  // namespace

std::vector<Channel> make_channels(const std::vector<std::string>& joint_names) {
  std::vector<Channel> table;
  table.push_back(scalar("state", "1",
                         "walking state: 0 idle, 1 initialize, 2 single support, 3 double support",
                         &Frame::state));
  table.push_back(
      scalar("support_side", "1", "support foot: 0 left, 1 right", &Frame::support_side));
  table.push_back(
      scalar("phase_time", "s", "time since lift-off of this step", &Frame::phase_time));
  table.push_back(scalar("t_ss", "s", "single support duration of this step", &Frame::t_ss));
  table.push_back(scalar("planned_t_ss", "s", "single support duration before it was adjusted",
                         &Frame::planned_t_ss));
  table.push_back(scalar("t_ds", "s", "double support duration of this step", &Frame::t_ds));
  table.push_back(scalar("step_count", "1", "steps landed", &Frame::step_count));
  table.push_back(scalar("recovering", "1",
                         "1 while it steps because standing would have been a fall",
                         &Frame::recovering));

  table.push_back(vector<3>("com", "m", "centre of mass", &Frame::com));
  table.push_back(
      vector<3>("com_velocity", "m/s", "velocity of the centre of mass", &Frame::com_velocity));
  table.push_back(vector<2>("dcm", "m", "divergent component of motion", &Frame::dcm));
  table.push_back(vector<2>("zmp", "m", "zero moment point from the contact forces", &Frame::zmp));
  table.push_back(vector<3>("angular_momentum", "N m s",
                            "angular momentum about the centre of mass", &Frame::angular_momentum));
  table.push_back(vector<3>("com_sensed", "m",
                            "centre of mass as control knows it, about the support foot",
                            &Frame::com_sensed));
  table.push_back(vector<2>("dcm_sensed", "m", "DCM as control knows it, about the support foot",
                            &Frame::dcm_sensed));
  table.push_back(
      {"drift",
       "world",
       "of the world that control knows, undone in all other channels: turn, then shift",
       {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"yaw", "rad"}},
       1,
       [](const Frame& f, Values& out) {
         const Vec3& shift = f.drift.shift;
         out.insert(out.end(), {shift.x(), shift.y(), shift.z(), f.drift.yaw});
       }});
  table.push_back(vector<2>("com_reference", "m", "planned centre of mass", &Frame::com_reference));
  table.push_back(vector<2>("dcm_reference", "m", "planned DCM", &Frame::dcm_reference));
  table.push_back(vector<2>("zmp_reference", "m", "planned ZMP", &Frame::zmp_reference));
  table.push_back(
      vector<2>("dcm_estimate", "m", "DCM as the Kalman filter sees it", &Frame::dcm_estimate));
  table.push_back(
      vector<2>("zmp_command", "m", "ZMP that the controller asks for", &Frame::zmp_command));

  table.push_back(
      vector<3>("base_position", "m", "origin of the base link", &Frame::base_position));
  table.push_back({"base_orientation", "world", "orientation of the base link, unit quaternion",
                   components({"w", "x", "y", "z"}, "1"), 1, [](const Frame& f, Values& out) {
                     const auto& q = f.base_orientation;
                     out.insert(out.end(), {q.w(), q.x(), q.y(), q.z()});
                   }});
  table.push_back(foot("left_foot", "centre of the left sole", &Frame::feet, Side::left));
  table.push_back(foot("right_foot", "centre of the right sole", &Frame::feet, Side::right));
  table.push_back(
      foot("left_foot_target", "where the left sole is wanted", &Frame::foot_targets, Side::left));
  table.push_back(foot("right_foot_target", "where the right sole is wanted", &Frame::foot_targets,
                       Side::right));
  table.push_back({"foot_load", "world", "normal force under each foot",
                   components({"left", "right"}, "N"), 1, [](const Frame& f, Values& out) {
                     out.insert(out.end(), f.foot_load.begin(), f.foot_load.end());
                   }});
  table.push_back(
      joints("joint_position", "rad", "joint angles", joint_names, &Frame::joint_position));
  table.push_back(
      joints("joint_velocity", "rad/s", "joint velocities", joint_names, &Frame::joint_velocity));
  table.push_back(
      joints("joint_torque", "N m", "joint torques that acted", joint_names, &Frame::joint_torque));

  table.push_back(footstep("planned_step", "next foothold before adjustment; side 0 left, 1 right",
                           &Frame::planned_step));
  table.push_back(
      footstep("adjusted_step", "next foothold: where the swing foot goes", &Frame::adjusted_step));
  table.push_back({"preview", "world", "the steps to come, the next one first", footstep_components,
                   engine::preview_steps, [](const Frame& f, Values& out) {
                     for (std::size_t i = 0; i < f.preview_count; ++i) append(f.preview[i], out);
                   }});
  table.push_back({"support_polygon", "world", "corners of the support polygon, counter-clockwise",
                   components({"x", "y"}, "m"), max_polygon_vertices,
                   [](const Frame& f, Values& out) {
                     for (std::size_t i = 0; i < f.support_polygon_count; ++i) {
                       const Vec2& corner = f.support_polygon[i];
                       out.insert(out.end(), {corner.x(), corner.y()});
                     }
                   }});
  table.push_back(region("reachable_footholds",
                         "where the foot in the air can be put down, counter-clockwise; empty "
                         "unless in single support",
                         &Frame::reachable_footholds));
  table.push_back(region("capture_region",
                         "where that foot has to land at the planned time for a fall to be "
                         "avoidable, counter-clockwise; whether the leg gets there is left aside",
                         &Frame::capture_region));
  table.push_back({"swing_path", "world",
                   "the way of the foot in the air from here to touchdown, in equal times",
                   components({"x", "y", "z"}, "m"), swing_path_points,
                   [](const Frame& f, Values& out) {
                     for (std::size_t i = 0; i < f.swing_path_count; ++i) {
                       const Vec3& point = f.swing_path[i];
                       out.insert(out.end(), {point.x(), point.y(), point.z()});
                     }
                   }});
  table.push_back({"ground_forces",
                   "world",
                   "forces of the ground on the robot in the tick before, each with its point; of "
                   "more than 16 the first ones",
                   {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"fx", "N"}, {"fy", "N"}, {"fz", "N"}},
                   max_contacts,
                   [](const Frame& f, Values& out) {
                     for (std::size_t i = 0; i < f.ground_force_count; ++i) {
                       const auto& [point, force] = f.ground_forces[i];
                       out.insert(out.end(), {point.x(), point.y(), point.z(), force.x(), force.y(),
                                              force.z()});
                     }
                   }});
  table.push_back(vector<3>("push_force", "N", "sum of the pushes that act", &Frame::push_force));
  table.push_back(vector<3>("push_point", "m", "where the first acting push acts, else the CoM",
                            &Frame::push_point));
  table.push_back(scalar("fallen", "1", "1 once the robot has fallen", &Frame::fallen));
  return table;
}

const Channel* find_channel(std::span<const Channel> channels, const std::string& name) {
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const Channel& c) { return c.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

}  // namespace stagger::sim
