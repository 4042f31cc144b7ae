#include "sim/robot/biped_figures.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sim/robot/rigid_body.h"

namespace stagger::sim {
namespace {

using engine::Side;

constexpr double standard_gravity = 9.81;       // [m/s^2]
constexpr double greatest_effort = 1000.0;      // [N m]
constexpr double greatest_effort_share = 10.0;  // of m g l

/// Of m g l: what robots/kasaei has (30 kg, legs of 1 m: 150, 200, 120 and 80 N m).
double assumed_share(LegRole role) {
  if (is_hip(role)) return 0.5;
  if (role == LegRole::knee) return 0.7;
  return role == LegRole::ankle_pitch ? 0.4 : 0.3;
}

/// To so many digits after the point.
double rounded(double value, int digits) {
  const double scale = std::pow(10.0, digits);
  return std::round(value * scale) / scale;
}

/// Sole's edges from the ankle's centre along the sole's x and y axes.
struct Edges {
  double ahead, behind, left, right;
};

Edges edges_of(const Robot& robot, const Legs& legs, Side side) {
  RobotState zero;
  zero.q = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(robot.model.joint_count()));
  const Eigen::Isometry3d sole =
      body_poses(robot.model, zero)[robot.foot_body(side)] * robot.sole_in_body(side);
  const Vec3 ankle = sole.inverse() * legs.leg[index(side)].ankle;
  const SoleDescription& size = robot.description.feet[index(side)].sole;
  return {0.5 * size.length - ankle.x(), 0.5 * size.length + ankle.x(),
          0.5 * size.width - ankle.y(), 0.5 * size.width + ankle.y()};
}

}  // namespace

std::map<std::string, MotorLimits> assumed_motors(const RobotModel& model, const Legs& legs,
                                                  Quirks& quirks) {
  std::map<std::string, MotorLimits> motors;
  const double scale = model.mass() * standard_gravity * legs.leg[0].length();
  for (const Leg& leg : legs.leg) {
    for (const LegJoint& joint : leg.joints) {
      const Body& body = model.bodies[static_cast<std::size_t>(model.joint_index(joint.name)) + 1];
      if (body.effort > 0.0 && body.effort <= greatest_effort &&
          body.effort <= greatest_effort_share * scale) {
        continue;
      }
      const double effort = std::max(0.1, rounded(assumed_share(joint.role) * scale, 1));
      motors[joint.name].effort = effort;
      std::ostringstream what;
      std::ostringstream answer;
      if (std::isinf(body.effort)) {
        what << "gives no torque limit";
      } else {
        what << "its torque limit of " << body.effort << " N m cannot be true of a robot of "
             << model.mass() << " kg";
      }
      answer << "ASSUMED " << effort << " N m: give the real figure in motors/effort_nm";
      quirks.push_back({"joint '" + joint.name + "'", what.str(), answer.str()});
    }
  }
  return motors;
}

BipedFigures figures_of(const Robot& robot, const Legs& legs, const StandingPose& pose) {
  BipedFigures figures;
  figures.mass = robot.model.mass();
  figures.com_height = pose.com_height;
  figures.omega = std::sqrt(standard_gravity / pose.com_height);
  figures.leg_length = legs.leg[0].length();
  figures.leg_share = pose.leg_share;
  figures.stance_width = pose.stance_width;

  const double weight = figures.mass * standard_gravity;
  const Edges edges = edges_of(robot, legs, Side::left);
  double pitch = 0.0;
  double roll = 0.0;
  for (const LegJoint& joint : legs.leg[0].joints) {
    const int i = robot.model.joint_index(joint.name);
    const double limit = robot.model.bodies[static_cast<std::size_t>(i) + 1].effort / weight;
    if (joint.role == LegRole::ankle_pitch) pitch = limit;
    if (joint.role == LegRole::ankle_roll) roll = limit;
  }
  figures.ankle_ahead = std::min(edges.ahead, pitch);
  figures.ankle_behind = std::min(edges.behind, pitch);
  figures.ankle_outward = std::min(edges.left, roll);
  figures.ankle_inward = std::min(edges.right, roll);

  // All of the weight goes through the left foot, straight below the CoM. For hips and knee, whose
  // levers are those to what they carry, this is single support with the body moved over the foot.
  RigidBody body(robot.model);
  body.update(nominal_state(robot), standard_gravity);
  Matrix6X jacobian(6, body.nv());
  const Vec3 below(body.com().x(), body.com().y(), 0.0);
  body.jacobian(robot.foot_body(Side::left), below, jacobian);
  for (const LegJoint& joint : legs.leg[0].joints) {
    if (is_ankle(joint.role)) continue;
    const int i = robot.model.joint_index(joint.name);
    const double torque = body.bias()[6 + i] - weight * jacobian(2, 6 + i);
    figures.holding.push_back(
        {joint.name, std::abs(torque), robot.model.bodies[static_cast<std::size_t>(i) + 1].effort});
  }
  return figures;
}

Quirks weaknesses(const BipedFigures& figures, const Robot& robot) {
  Quirks quirks;
  for (const HoldingTorque& holding : figures.holding) {
    if (holding.needed <= holding.limit) continue;
    std::ostringstream text;
    text << "needs " << holding.needed << " N m to hold the robot on one leg, limit "
         << holding.limit << " N m";
    quirks.push_back({"joint '" + holding.joint + "'", text.str(),
                      holding.needed > 3.0 * holding.limit
                          ? "looks like a figure before the gears: correct motors/effort_nm"
                          : "it will not be able to walk slowly"});
  }
  const SoleDescription& sole = robot.description.feet[0].sole;
  if (figures.ankle_ahead + figures.ankle_behind < 0.5 * sole.length) {
    std::ostringstream text;
    text << "its torque moves the ZMP by " << figures.ankle_ahead + figures.ankle_behind
         << " m of the sole's " << sole.length << " m";
    quirks.push_back({"ankle pitch", text.str(), "control keeps to the torque limit"});
  }
  return quirks;
}

}  // namespace stagger::sim
