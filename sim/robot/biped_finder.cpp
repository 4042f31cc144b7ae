#include "sim/robot/biped_finder.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sim/frame.h"
#include "sim/robot/biped_figures.h"
#include "sim/robot/biped_sole.h"
#include "sim/robot/urdf_shapes.h"
#include "sim/robot/walk_defaults.h"

namespace stagger::sim {
namespace {

using engine::Side;

/// Turns smaller than this are rounding errors of the file [rad].
constexpr double same_direction = 1e-4;
constexpr double tilt_worth_telling = 0.01;  // [rad]

double to_micrometres(double value) { return std::round(value * 1e6) / 1e6 + 0.0; }

/// Roll, pitch, yaw about fixed axes, as a URDF means them; rotation_of() is the way back.
Vec3 rpy_of(const Eigen::Matrix3d& r) {
  if (Eigen::AngleAxisd(r).angle() < same_direction) return Vec3::Zero();
  const double across = std::hypot(r(2, 1), r(2, 2));
  Vec3 rpy;
  rpy.y() = std::atan2(-r(2, 0), across);
  if (across > 1e-9) {
    rpy.x() = std::atan2(r(2, 1), r(2, 2));
    rpy.z() = std::atan2(r(1, 0), r(0, 0));
  } else {
    rpy.x() = 0.0;
    rpy.z() = std::atan2(-r(0, 1), r(1, 1));
  }
  return rpy;
}

/// Joints that are locked stay at zero, or as near to it as their range lets them.
std::map<std::string, double> locked_at(const Legs& legs, const RobotModel& survey,
                                        Quirks& quirks) {
  std::map<std::string, double> locked;
  for (const std::string& name : legs.locked) {
    double& angle = locked[name];
    const int joint = survey.joint_index(name);
    if (joint < 0) continue;  // one that does not turn
    const Body& body = survey.bodies[static_cast<std::size_t>(joint) + 1];
    angle = std::clamp(0.0, body.lower, body.upper);
    if (angle == 0.0) continue;
    std::ostringstream text;
    text << "its range " << body.lower << " to " << body.upper << " rad leaves out zero";
    quirks.push_back(
        {"joint '" + name + "'", text.str(), "locked at " + std::to_string(angle) + " rad"});
  }
  return locked;
}

/// The heaviest link of the base's body: what is above the hips is one body, all else being locked.
std::string torso_of(const RobotModel& model) {
  std::string torso = model.bodies[0].name;
  double most = 0.0;
  for (const auto& [link, place] : model.links) {
    if (place.body != 0 || place.mass <= most) continue;
    torso = link;
    most = place.mass;
  }
  return torso;
}

class Finder {
 public:
  explicit Finder(const std::filesystem::path& urdf) { found_.urdf = urdf; }

  BipedFinding run() {
    ImportReport report;
    const RobotModel survey =
        import_urdf_file(found_.urdf, {ImportMode::survey, {}, {}, {}}, &report);
    found_.quirks = report.quirks;
    found_.meshes = report.meshes;
    found_.legs = find_legs(survey, report);
    take(found_.legs.quirks);

    BipedDescription& biped = found_.robot.description;
    biped.urdf = found_.urdf.filename().string();
    biped.mend = true;
    biped.base = found_.legs.base;
    biped.locked = locked_at(found_.legs, survey, found_.quirks);
    biped.motors = assumed_motors(survey, found_.legs, found_.quirks);
    ImportReport again;
    RobotModel& model = found_.robot.model;
    model =
        import_urdf_file(found_.urdf, {ImportMode::mend, {}, biped.locked, biped.motors}, &again);
    take(again.mended);
    found_.robot.name = model.name;
    found_.robot.folder = found_.urdf.parent_path();
    // Locked joints need not be at zero: the points and axes of the legs are those of this model.
    Legs placed = find_legs(model, again);
    found_.legs.axes = placed.axes;
    found_.legs.leg = placed.leg;

    describe_feet();
    describe_torso();
    const StandingPose pose = find_standing_pose(found_.robot, found_.legs);
    biped.nominal_pose = pose.joints;
    biped.walk = walk_defaults(biped_proportions(found_.robot));
    found_.figures = figures_of(found_.robot, found_.legs, pose);
    tell_pose(pose);
    take(weaknesses(found_.figures, found_.robot));
    return std::move(found_);
  }

 private:
  void take(const Quirks& quirks) {
    found_.quirks.insert(found_.quirks.end(), quirks.begin(), quirks.end());
  }

  void describe_feet() {
    RobotState zero;
    zero.q = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(found_.robot.model.joint_count()));
    const auto poses = body_poses(found_.robot.model, zero);
    engine::PerFoot<FoundSole> soles;
    for (const Side side : {Side::left, Side::right}) {
      FootDescription& foot = found_.robot.description.feet[index(side)];
      foot.link = found_.legs.leg[index(side)].foot;
      const int body = found_.robot.foot_body(side);
      FoundSole& sole = soles[index(side)];
      try {
        sole = find_sole(found_.robot.model.bodies[static_cast<std::size_t>(body)],
                         poses[body].linear().transpose() * found_.legs.axes);
      } catch (const CannotWalk& reason) {
        throw CannotWalk(reason.what() + lost_geometry(body));
      }
      if (sole.tilt > tilt_worth_telling) {
        std::ostringstream text;
        text << "its sole is tilted by " << sole.tilt << " rad at the zero pose";
        found_.quirks.push_back(
            {"foot '" + foot.link + "'", text.str(), "flat in the nominal pose"});
      }
      const Vec3 centre = sole.pose.translation();
      foot.sole.position = centre.unaryExpr(&to_micrometres);
      foot.sole.rpy = rpy_of(sole.pose.linear()).unaryExpr(&to_micrometres);
    }
    // The engine knows one size for both.
    const double length = std::min(soles[0].length, soles[1].length);
    const double width = std::min(soles[0].width, soles[1].width);
    for (FootDescription& foot : found_.robot.description.feet) {
      foot.sole.length = to_micrometres(length);
      foot.sole.width = to_micrometres(width);
    }
    if (std::abs(soles[0].length - soles[1].length) > 1e-3 ||
        std::abs(soles[0].width - soles[1].width) > 1e-3) {
      found_.quirks.push_back(
          {"feet", "the soles are not of one size", "the lesser counts for both"});
    }
  }

  /// What of a body's geometry was left out, and why: it may be the reason for a refusal.
  std::string lost_geometry(int body) const {
    std::string text;
    for (const Quirk& quirk : found_.quirks) {
      if (quirk.answer != geometry_left_out) continue;
      for (const auto& [link, place] : found_.robot.model.links) {
        if (place.body != body || quirk.where.find("'" + link + "'") == std::string::npos) continue;
        text += "; ";
        text += quirk.where;
        text += ": ";
        text += quirk.what;
        break;
      }
    }
    return text;
  }

  void describe_torso() {
    BipedDescription& biped = found_.robot.description;
    biped.torso = torso_of(found_.robot.model);
    const Eigen::Matrix3d frame = found_.robot.model.links.at(biped.torso).pose.linear();
    biped.torso_rpy = rpy_of(frame.transpose() * found_.legs.axes).unaryExpr(&to_micrometres);
  }

  void tell_pose(const StandingPose& pose) {
    if (pose.leg_share > 0.955) return;
    std::ostringstream text;
    text << "no pose with the hips at 0.96 of the leg's length fits its joint limits";
    std::ostringstream answer;
    answer << "stands at " << pose.leg_share;
    found_.quirks.push_back({"legs", text.str(), answer.str()});
  }

  BipedFinding found_;
};

}  // namespace

BipedFinding find_biped(const std::filesystem::path& urdf) { return Finder(urdf).run(); }

}  // namespace stagger::sim
