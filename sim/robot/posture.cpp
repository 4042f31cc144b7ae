#include "sim/robot/posture.h"

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "sim/robot/legs.h"

namespace stagger::sim {
namespace {

using engine::PerFoot;
using engine::Side;
using engine::Vec2;

// A state is as low as wanted when it is this near [m].
constexpr double tolerance = 1e-9;
// A description gives a height with its own rounding: no lower for so little [m].
constexpr double angle_rounding = 1e-4;

/// Joints that turn a leg forwards, and the sign that makes positive angles turn about +y.
struct Hinge {
  Eigen::Index joint = 0;
  double sign = 1.0;
};
using Hinges = std::array<Hinge, 3>;

class Bending {
 public:
  Bending(const Robot& robot, const Height& height)
      : robot_(robot), height_(height), body_(robot.model), nominal_(nominal_state(robot)) {
    body_.update(nominal_);
    nominal_height_ = height_(body_);
    forward_ = forward();
    for (const Side side : {Side::left, Side::right}) find_hinges(side);
  }

  RobotState until(double most) {
    if (nominal_height_ <= most + angle_rounding || !has_hinges_) return nominal_;
    // Newton's method; begins with knees that bend enough to be away from straight.
    const double knee = hinges_[0][1].sign * nominal_.q[hinges_[0][1].joint];
    Vec2 turn(knee < 0.0 ? 0.1 : -0.1, knee < 0.0 ? -0.2 : 0.2);
    constexpr int iterations = 30;
    for (int i = 0; i < iterations; ++i) {
      const Vec2 error = measured(turn) - Vec2(most, forward_);
      if (error.norm() < tolerance) break;
      Eigen::Matrix2d slope;
      constexpr double step = 1e-6;
      for (int k = 0; k < 2; ++k) {
        slope.col(k) = (measured(turn + step * Vec2::Unit(k)) - measured(turn)) / step;
      }
      turn -= slope.inverse() * error;
    }
    const bool found = (measured(turn) - Vec2(most, forward_)).norm() < 10.0 * tolerance;
    const RobotState state = turned(turn);
    return found && within_limits(state) ? state : nominal_;
  }

 private:
  void find_hinges(Side side) {
    const std::vector<int> bodies = turning_about(body_, robot_, side, Vec3::UnitY());
    if (bodies.size() != 3) {
      has_hinges_ = false;
      return;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 axis = body_.rotation(bodies[i]) * robot_.model.bodies[bodies[i]].axis;
      hinges_[engine::index(side)][i] = {bodies[i] - 1, axis.y() > 0.0 ? 1.0 : -1.0};
    }
  }

  /// Hips and knees turned by these angles from the nominal pose, ankles so that the soles are
  /// flat.
  RobotState turned(const Vec2& turn) const {
    Eigen::VectorXd q = nominal_.q;
    for (const Hinges& leg : hinges_) {
      const std::array<double, 3> angles{turn.x(), turn.y(), -turn.x() - turn.y()};
      for (std::size_t i = 0; i < 3; ++i) q[leg[i].joint] += leg[i].sign * angles[i];
    }
    return standing_state(robot_, q);
  }

  double forward() const {
    const Vec3 middle =
        0.5 * (sole_centre(body_, robot_, Side::left) + sole_centre(body_, robot_, Side::right));
    return (body_.com() - middle).x();
  }

  /// The height and how far forward the CoM is.
  Vec2 measured(const Vec2& turn) {
    body_.update(turned(turn));
    return {height_(body_), forward()};
  }

  bool within_limits(const RobotState& state) const {
    for (std::size_t j = 0; j < robot_.model.joint_count(); ++j) {
      const Body& body = robot_.model.bodies[j + 1];
      const double angle = state.q[static_cast<Eigen::Index>(j)];
      if (!(angle >= body.lower && angle <= body.upper)) return false;
    }
    return true;
  }

  const Robot& robot_;
  const Height& height_;
  RigidBody body_;
  RobotState nominal_;
  double nominal_height_ = 0.0;
  double forward_ = 0.0;
  bool has_hinges_ = true;
  PerFoot<Hinges> hinges_;
};

}  // namespace

RobotState lowered_state(const Robot& robot, const Height& height, double most) {
  return Bending(robot, height).until(most);
}

double nominal_com_height(const Robot& robot) {
  RigidBody body(robot.model);
  body.update(nominal_state(robot));
  return body.com().z();
}

RobotState walking_state(const Robot& robot) {
  return lowered_state(
      robot, [](const RigidBody& body) { return body.com().z(); },
      robot.description.walk.com_height_m);
}

}  // namespace stagger::sim
