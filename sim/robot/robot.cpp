#include "sim/robot/robot.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "engine/parameters.h"
#include "sim/frame.h"
#include "sim/json_file.h"
#include "sim/robot/dynamic_scale.h"
#include "sim/robot/urdf_import.h"
#include "sim/robot/walk_defaults.h"

namespace stagger::sim {
namespace {

using engine::Side;

constexpr int fewest_leg_joints = 5;
// How far the right sole may be from the left sole's plane in the nominal pose.
constexpr double sole_height_tolerance = 1e-3;  // [m]
constexpr double sole_tilt_tolerance = 2e-3;    // [rad]

std::string listed(const std::vector<std::string>& names) {
  std::string result;
  for (const std::string& name : names) result += (result.empty() ? "" : ", ") + name;
  return result;
}

std::vector<std::string> link_names(const RobotModel& model) {
  std::vector<std::string> names;
  for (const auto& [name, place] : model.links) names.push_back(name);
  return names;
}

/// Checks that the description and the URDF fit together.
class Checker {
 public:
  Checker(const Robot& robot, JsonErrors& errors) : robot_(robot), errors_(errors) {}

  void run() {
    const BipedDescription& biped = robot_.description;
    check_link("/base", biped.base);
    check_link("/torso", biped.torso);
    const bool left = check_foot("/feet/left", Side::left);
    const bool right = check_foot("/feet/right", Side::right);
    const bool pose = check_pose();
    if (!left || !right || !pose) return;
    if (robot_.foot_body(Side::left) == robot_.foot_body(Side::right)) {
      errors_.add("/feet/right/link",
                  "is part of the left foot's body; allowed: another leg's foot");
      return;
    }
    check_soles_level();
  }

  /// Whether the widths go together, given or by formula.
  void check_widths() {
    const WalkDescription& walk = robot_.description.walk;
    const double sole_width = robot_.description.feet[0].sole.width;
    const double clearance = engine::Parameters().foot_clearance * dynamic_scale(robot_).length;
    std::ostringstream text;
    if (walk.min_step_width_m < sole_width + clearance) {
      text << "is " << walk.min_step_width_m
           << " m, which leaves no gap between the soles; allowed: at least the sole's width and "
           << clearance << " m";
      errors_.add("/walk/min_step_width_m", text.str());
    } else if (walk.min_step_width_m > walk.stance_width_m) {
      text << "is " << walk.min_step_width_m << " m; allowed: at most stance_width_m ("
           << walk.stance_width_m << " m)";
      errors_.add("/walk/min_step_width_m", text.str());
    } else if (walk.max_step_width_m < walk.stance_width_m) {
      text << "is " << walk.max_step_width_m << " m; allowed: at least stance_width_m ("
           << walk.stance_width_m << " m)";
      errors_.add("/walk/max_step_width_m", text.str());
    }
  }

 private:
  bool check_link(const std::string& pointer, const std::string& name) {
    if (robot_.model.links.contains(name)) return true;
    errors_.add(pointer, "is \"" + name + "\", which " + robot_.description.urdf +
                             " has no link for; allowed: " + listed(link_names(robot_.model)));
    return false;
  }

  bool check_foot(const std::string& pointer, Side side) {
    if (!check_link(pointer + "/link", robot_.description.feet[index(side)].link)) return false;
    int joints = 0;
    for (int i = robot_.foot_body(side); i > 0; i = robot_.model.bodies[i].parent) ++joints;
    if (joints >= fewest_leg_joints) return true;
    errors_.add(pointer + "/link", "is carried by " + std::to_string(joints) +
                                       " joints; allowed: a leg of at least " +
                                       std::to_string(fewest_leg_joints) + " joints");
    return false;
  }

  bool check_pose() {
    bool fits = true;
    for (const auto& [joint, angle] : robot_.description.nominal_pose) {
      const int i = robot_.model.joint_index(joint);
      if (i >= 0) continue;
      errors_.add("/nominal_pose/" + joint, "is no joint of " + robot_.description.urdf +
                                                "; allowed: " + listed(robot_.model.joint_names()));
      fits = false;
    }
    for (std::size_t i = 1; i < robot_.model.bodies.size(); ++i) {
      const Body& body = robot_.model.bodies[i];
      const auto found = robot_.description.nominal_pose.find(body.joint);
      const bool given = found != robot_.description.nominal_pose.end();
      const double angle = given ? found->second : 0.0;
      if (angle >= body.lower && angle <= body.upper) continue;
      std::ostringstream text;
      text << (given ? "is " : "is not given and so 0; joint ") << (given ? "" : body.joint + " ");
      if (given) text << angle << "; ";
      text << "allowed: " << body.lower << " to " << body.upper << " rad";
      errors_.add(given ? "/nominal_pose/" + body.joint : "/nominal_pose", text.str());
      fits = false;
    }
    return fits;
  }

  void check_soles_level() {
    const RobotState state = nominal_state(robot_);
    const auto poses = body_poses(robot_.model, state);
    const Eigen::Isometry3d right =
        poses[robot_.foot_body(Side::right)] * robot_.sole_in_body(Side::right);
    const double tilt = std::acos(std::clamp(right.linear()(2, 2), -1.0, 1.0));
    const double height = 2.0 * right.translation().z();  // the left one is as far below 0
    if (std::abs(height) <= sole_height_tolerance && tilt <= sole_tilt_tolerance) return;
    std::ostringstream text;
    text << "puts the right sole " << height << " m above the left one and tilts it by " << tilt
         << " rad; allowed: up to " << sole_height_tolerance << " m and " << sole_tilt_tolerance
         << " rad";
    errors_.add("/nominal_pose", text.str());
  }

  const Robot& robot_;
  JsonErrors& errors_;
};

}  // namespace

int Robot::foot_body(Side side) const {
  return model.links.at(description.feet[index(side)].link).body;
}

Eigen::Isometry3d Robot::sole_in_body(Side side) const {
  const FootDescription& foot = description.feet[index(side)];
  Eigen::Isometry3d sole =
      model.links.at(foot.link).pose * Eigen::Translation3d(foot.sole.position);
  sole.linear() *= rotation_of(foot.sole.rpy);
  return sole;
}

Eigen::Matrix3d Robot::torso_in_body() const {
  return model.links.at(description.torso).pose.linear() * rotation_of(description.torso_rpy);
}

std::shared_ptr<const Robot> load_robot(const std::filesystem::path& folder) {
  auto robot = std::make_shared<Robot>();
  robot->folder = folder;
  robot->name = std::filesystem::absolute(folder).lexically_normal().filename().string();
  read_json_file(folder / "robot.json", [&](JsonReader& in) {
    robot->description = read_biped_description(in);
    const std::filesystem::path urdf = robot->description.urdf;
    if (urdf != urdf.filename()) {
      in.refuse("urdf", "is \"" + urdf.string() + "\"; allowed: a file beside robot.json");
    }
    if (!in.errors().empty()) return;
    const BipedDescription& biped = robot->description;
    ImportOptions options;
    options.mode = biped.mend ? ImportMode::mend : ImportMode::strict;
    options.locked = biped.locked;
    options.motors = biped.motors;
    robot->model = import_urdf_file(folder / urdf, options);
    if (robot->model.joint_count() > max_joints) {
      in.refuse("urdf", "has " + std::to_string(robot->model.joint_count()) +
                            " moving joints; allowed: at most " + std::to_string(max_joints));
    }
    Checker checker(*robot, in.errors());
    checker.run();
    if (!in.errors().empty()) return;
    const GivenWalk& given = robot->description.given_walk;
    BipedProportions proportions = biped_proportions(*robot);
    proportions.com_height = given.com_height_m.value_or(proportions.com_height);
    proportions.stance_width = given.stance_width_m.value_or(proportions.stance_width);
    robot->description.walk = given.over(walk_defaults(proportions));
    checker.check_widths();
  });
  return robot;
}

std::vector<std::string> list_robots(const std::filesystem::path& robots) {
  std::vector<std::string> names;
  std::error_code ignored;  // no such folder: no robots
  for (const auto& entry : std::filesystem::directory_iterator(robots, ignored)) {
    if (std::filesystem::exists(entry.path() / "robot.json")) {
      names.push_back(entry.path().filename().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

RobotState standing_state(const Robot& robot, const Eigen::VectorXd& q) {
  RobotState state;
  state.q = q;
  state.qd = Eigen::VectorXd::Zero(q.size());
  const auto sole = [&](Side side) -> Eigen::Isometry3d {
    return body_poses(robot.model, state)[robot.foot_body(side)] * robot.sole_in_body(side);
  };
  const Vec3 up = sole(Side::left).linear().col(2);
  state.base_orientation = Eigen::Quaterniond::FromTwoVectors(up, Vec3::UnitZ());
  const Vec3 toes = sole(Side::left).linear().col(0);
  const double yaw = std::atan2(toes.y(), toes.x());
  // A base that looks ahead already is not turned at all, not even by a rounding error.
  if (yaw != 0.0) {
    state.base_orientation = Eigen::AngleAxisd(-yaw, Vec3::UnitZ()) * state.base_orientation;
  }
  state.base_position = -0.5 * (sole(Side::left).translation() + sole(Side::right).translation());
  return state;
}

RobotState nominal_state(const Robot& robot) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(robot.model.joint_count()));
  for (const auto& [joint, angle] : robot.description.nominal_pose) {
    q[robot.model.joint_index(joint)] = angle;
  }
  return standing_state(robot, q);
}

}  // namespace stagger::sim
