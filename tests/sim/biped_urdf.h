// URDFs of made-up bipeds, with the oddities of real ones at will.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "engine/types.h"

namespace stagger::sim {

/// How a biped is built. Lengths are shares of the leg unless they say metres.
struct BipedPlan {
  enum class Foot { box, spheres, points, cylinders, mesh, two_boxes, ball, none };

  double mass = 30.0;        ///< [kg]
  double leg = 0.8;          ///< hip to ankle [m]
  std::string hip = "YRP";   ///< from the pelvis: yaw, roll, pitch; others are left out
  std::string ankle = "PR";  ///< from the shank
  double hip_offset = 0.0;   ///< of each hip joint below and before the one before it
  double hip_tilt = 0.0;     ///< of the pitch axis, in the plane across [rad]
  double heading = 0.0;      ///< of the robot in its root's frame [rad]
  double foot_tilt = 0.0;    ///< toes down at the zero pose [rad]
  double foot_shift = 0.2;   ///< of the sole's centre ahead of the ankle, of its length
  bool z_axes = false;       ///< every axis is (0, 0, 1): frames are turned instead
  bool mirrored = false;     ///< right joints turn the other way
  bool waist = false;        ///< the root is the torso, the legs hang behind a yaw joint
  bool arms = false;         ///< two joints each; the shoulder's range leaves out zero
  bool world = false;        ///< the root is a link without mass, on a floating joint
  bool limits = true;        ///< false: no lower and upper
  double effort = 1.0;       ///< of what is plausible; 0: effort 0
  Foot foot = Foot::box;
  std::string mesh = "foot.stl";
  std::string extra = {};  ///< before </robot>
};

class BipedUrdf {
 public:
  explicit BipedUrdf(const BipedPlan& plan) : plan_(plan) {}

  std::string text() {
    const Frame base = plan_.waist ? torso_first() : pelvis_first();
    for (const double side : {1.0, -1.0}) add_leg(base, side);
    if (plan_.arms) add_arms();
    return "<?xml version=\"1.0\"?>\n<robot name=\"made_up\">\n" + out_.str() + plan_.extra +
           "</robot>\n";
  }

 private:
  using Vec3 = engine::Vec3;
  using Matrix = Eigen::Matrix3d;

  /// A link's frame, in a world with x ahead, y left, z up and the hips' middle at the origin.
  struct Frame {
    std::string link;
    Matrix turn = Matrix::Identity();
    Vec3 at = Vec3::Zero();
  };

  static std::string xyz(const Vec3& v) {
    std::ostringstream text;
    text.precision(12);
    text << v.x() << ' ' << v.y() << ' ' << v.z();
    return text.str();
  }
  static std::string rpy(const Matrix& r) {
    return xyz({std::atan2(r(2, 1), r(2, 2)), std::atan2(-r(2, 0), std::hypot(r(2, 1), r(2, 2))),
                std::atan2(r(1, 0), r(0, 0))});
  }
  static std::string origin(const Frame& frame, const Vec3& at, const Matrix& turn) {
    return "<origin xyz=\"" + xyz(frame.turn.transpose() * (at - frame.at)) + "\" rpy=\"" +
           rpy(frame.turn.transpose() * turn) + "\"/>";
  }

  /// Inertia of an even box whose centre is `at`, with edges along the world's axes.
  static std::string inertial(const Frame& frame, double mass, const Vec3& at, const Vec3& size) {
    const Vec3 squares = size.cwiseAbs2();
    const Vec3 moments = mass / 12.0 * (Vec3::Constant(squares.sum()) - squares);
    std::ostringstream text;
    text.precision(12);
    text << "  <inertial>" << origin(frame, at, Matrix::Identity()) << "<mass value=\"" << mass
         << "\"/><inertia ixx=\"" << moments.x() << "\" ixy=\"0\" ixz=\"0\" iyy=\"" << moments.y()
         << "\" iyz=\"0\" izz=\"" << moments.z() << "\"/></inertial>\n";
    return text.str();
  }
  static std::string collision(const Frame& frame, const Vec3& at, const Matrix& turn,
                               const std::string& geometry) {
    return "  <collision>" + origin(frame, at, turn) + "<geometry>" + geometry +
           "</geometry></collision>\n";
  }
  static std::string box(const Vec3& size) { return "<box size=\"" + xyz(size) + "\"/>"; }

  void link(const Frame& frame, const std::string& inside) {
    out_ << "<link name=\"" << frame.link << "\">\n" << inside << "</link>\n";
  }

  void fixed(const Frame& parent, const Frame& child, const std::string& type = "fixed") {
    out_ << "<joint name=\"" << child.link << "_mount\" type=\"" << type << "\">"
         << origin(parent, child.at, child.turn) << "<parent link=\"" << parent.link
         << "\"/><child link=\"" << child.link << "\"/></joint>\n";
  }

  /// The frame of a link on a joint that turns about `axis`.
  Frame joint(const Frame& parent, const std::string& name, const Vec3& at, Vec3 axis, double sign,
              double lower, double upper, double effort) {
    axis = world_ * axis * sign;
    Frame child{name + "_link", parent.turn, at};
    if (plan_.z_axes) {
      child.turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis).toRotationMatrix();
    }
    const Vec3 local = plan_.z_axes ? Vec3::UnitZ() : Vec3(child.turn.transpose() * axis);
    if (sign < 0.0) {
      std::swap(lower, upper);
      lower = -lower;
      upper = -upper;
    }
    out_ << "<joint name=\"" << name << "\" type=\"revolute\">"
         << origin(parent, child.at, child.turn) << "<parent link=\"" << parent.link
         << "\"/><child link=\"" << child.link << "\"/><axis xyz=\"" << xyz(local) << "\"/><limit ";
    if (plan_.limits) out_ << "lower=\"" << lower << "\" upper=\"" << upper << "\" ";
    out_ << "effort=\"" << effort << "\" velocity=\"15\"/></joint>\n";
    return child;
  }

  double strength(double share) const {
    return plan_.effort * share * plan_.mass * 9.81 * plan_.leg;
  }
  Vec3 place(double x, double y, double z) const { return world_ * Vec3(x, y, z) * plan_.leg; }

  std::string torso_parts(const Frame& frame) const {
    const Vec3 size = Vec3(0.2, 0.35, 0.55) * plan_.leg;
    const Vec3 at = place(0.0, 0.0, 0.42);
    return inertial(frame, 0.55 * plan_.mass, at, size) + collision(frame, at, world_, box(size));
  }
  std::string pelvis_parts(const Frame& frame) const {
    const Vec3 size = Vec3(0.18, 0.26, 0.1) * plan_.leg;
    const Vec3 at = place(0.0, 0.0, 0.08);
    return inertial(frame, 0.1 * plan_.mass, at, size) + collision(frame, at, world_, box(size));
  }

  Frame pelvis_first() {
    Frame root{"pelvis"};
    if (plan_.world) {
      link({"world"}, "");
      fixed({"world"}, root, "floating");
    }
    link(root, pelvis_parts(root));
    torso_ = {"torso", Matrix::Identity(), place(0.0, 0.0, 0.14)};
    link(torso_, torso_parts(torso_));
    fixed(root, torso_);
    return root;
  }
  Frame torso_first() {
    torso_ = {"trunk", Matrix::Identity(), place(0.0, 0.0, 0.14)};
    // The root's frame is the world's at its own place.
    link(torso_, torso_parts(torso_));
    const Frame pelvis = joint(torso_, "waist_yaw", place(0.0, 0.0, 0.12), Vec3::UnitZ(), 1.0, -1.5,
                               1.5, strength(0.3));
    link(pelvis, pelvis_parts(pelvis));
    return pelvis;
  }

  void add_arms() {
    for (const double side : {1.0, -1.0}) {
      const std::string name = side > 0.0 ? "left_" : "right_";
      const Frame shoulder = joint(torso_, name + "shoulder", place(0.0, 0.22 * side, 0.62),
                                   Vec3::UnitX(), side, 0.1, 2.0, strength(0.1));
      const Vec3 size = Vec3(0.06, 0.06, 0.3) * plan_.leg;
      const Vec3 middle = place(0.0, 0.24 * side, 0.47);
      link(shoulder, inertial(shoulder, 0.01 * plan_.mass, middle, size));
      const Frame elbow = joint(shoulder, name + "elbow", place(0.0, 0.24 * side, 0.32),
                                Vec3::UnitY(), 1.0, -2.0, 0.0, strength(0.1));
      // No mass of its own: some files have hands like this.
      link(elbow, "");
    }
  }

  void add_leg(const Frame& base, double side) {
    const double m = plan_.mass;
    const double turn = plan_.mirrored && side < 0.0 ? -1.0 : 1.0;
    const std::string name = side > 0.0 ? "left_" : "right_";
    Vec3 at(0.0, 0.12 * side, 0.0);
    Frame frame = base;
    for (std::size_t i = 0; i < plan_.hip.size(); ++i) {
      const char kind = plan_.hip[i];
      const bool last = i + 1 == plan_.hip.size();
      Vec3 axis = Vec3::UnitZ();
      double lower = side > 0.0 ? -0.8 : -1.0;
      double upper = side > 0.0 ? 1.0 : 0.8;
      if (kind == 'R') {
        axis = Vec3::UnitX();
        lower = side > 0.0 ? -0.6 : -1.0;
        upper = side > 0.0 ? 1.0 : 0.6;
      } else if (kind == 'P') {
        axis = Vec3(0.0, std::cos(plan_.hip_tilt), side * std::sin(plan_.hip_tilt));
        lower = -2.0;
        upper = 0.9;
      }
      const std::string full = kind == 'Y' ? "hip_yaw" : kind == 'R' ? "hip_roll" : "hip_pitch";
      frame = joint(frame, name + full, place(at.x(), at.y(), at.z()), axis, turn, lower, upper,
                    strength(0.5));
      if (last) {
        const Vec3 size = Vec3(0.1, 0.1, 0.4) * plan_.leg;
        const Vec3 middle = place(0.0, 0.12 * side, -0.22);
        link(frame,
             inertial(frame, 0.08 * m, middle, size) + collision(frame, middle, world_, box(size)));
      } else {
        const Vec3 size = Vec3(0.08, 0.08, 0.08) * plan_.leg;
        link(frame, inertial(frame, 0.02 * m, place(at.x(), at.y(), at.z()), size));
        at.z() -= plan_.hip_offset;
        at.x() += plan_.hip_offset;
      }
    }
    frame = joint(frame, name + "knee", place(0.0, 0.12 * side, -0.5), Vec3::UnitY(), turn, 0.0,
                  2.4, strength(0.7));
    const Vec3 shank = Vec3(0.08, 0.08, 0.4) * plan_.leg;
    link(frame, inertial(frame, 0.035 * m, place(0.0, 0.12 * side, -0.72), shank));
    for (std::size_t i = 0; i < plan_.ankle.size(); ++i) {
      const bool pitch = plan_.ankle[i] == 'P';
      frame = joint(frame, name + (pitch ? "ankle_pitch" : "ankle_roll"),
                    place(0.0, 0.12 * side, -1.0), pitch ? Vec3::UnitY() : Vec3::UnitX(), turn,
                    pitch ? -1.3 : -0.7, pitch ? 0.9 : 0.7, strength(pitch ? 0.4 : 0.3));
      if (i + 1 < plan_.ankle.size()) {
        const Vec3 size = Vec3(0.05, 0.05, 0.05) * plan_.leg;
        link(frame, inertial(frame, 0.006 * m, place(0.0, 0.12 * side, -1.0), size));
      }
    }
    add_foot(frame, name, side);
  }

  /// A sole of 0.24 x 0.12 leg lengths, 0.08 below the ankle.
  void add_foot(const Frame& frame, const std::string& name, double side) {
    using Foot = BipedPlan::Foot;
    const Matrix tilt =
        world_ * Eigen::AngleAxisd(plan_.foot_tilt, Vec3::UnitY()).toRotationMatrix();
    const Vec3 ankle = place(0.0, 0.12 * side, -1.0);
    const auto at = [&](double x, double y, double z) -> Vec3 {
      return ankle + tilt * Vec3(x + 0.24 * plan_.foot_shift, y, z) * plan_.leg;
    };
    std::string parts =
        inertial(frame, 0.02 * plan_.mass, at(0.0, 0.0, -0.06), Vec3(0.24, 0.12, 0.04) * plan_.leg);
    std::string child;
    const auto add_box = [&](double x, double length) {
      return collision(frame, at(x, 0.0, -0.06), tilt, box(Vec3(length, 0.12, 0.04) * plan_.leg));
    };
    const auto add_spheres = [&](double radius) {
      std::ostringstream size;
      size << "<sphere radius=\"" << radius << "\"/>";
      const double lift = radius / plan_.leg;
      for (const double x : {-0.12, 0.12}) {
        for (const double y : {-0.06, 0.06}) {
          parts += collision(frame, at(x, y, -0.08 + lift), tilt, size.str());
        }
      }
    };
    switch (plan_.foot) {
      case Foot::box:
        parts += add_box(0.0, 0.24);
        break;
      case Foot::spheres:
        add_spheres(0.005);
        break;
      case Foot::points:
        add_spheres(0.0);
        break;
      case Foot::cylinders: {
        std::ostringstream size;
        size << "<cylinder radius=\"" << 0.02 * plan_.leg << "\" length=\"" << 0.24 * plan_.leg
             << "\"/>";
        const Matrix along = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitY()).toRotationMatrix();
        for (const double y : {-0.06, 0.06}) {
          parts += collision(frame, at(0.0, y, -0.06), tilt * along, size.str());
        }
        break;
      }
      case Foot::mesh: {
        // Millimetres of a foot for a leg of 1 m.
        std::ostringstream mesh;
        mesh << "<mesh filename=\"" << plan_.mesh << "\" scale=\""
             << xyz(Vec3::Constant(1e-3 * plan_.leg)) << "\"/>";
        parts += collision(frame, at(0.0, 0.0, -0.08), tilt, mesh.str());
        break;
      }
      case Foot::two_boxes: {
        const Frame toes{name + "toes", frame.turn, at(0.06, 0.0, -0.06)};
        const std::string inside =
            collision(toes, at(0.06, 0.0, -0.06), tilt, box(Vec3(0.12, 0.12, 0.04) * plan_.leg));
        parts += add_box(-0.06, 0.12);
        child = toes.link;
        link(toes, inside);
        fixed(frame, toes);
        break;
      }
      case Foot::ball:
        parts += collision(frame, at(0.0, 0.0, -0.06), tilt, "<sphere radius=\"0.02\"/>");
        break;
      case Foot::none:
        break;
    }
    link(frame, parts);
  }

  const BipedPlan plan_;
  Matrix world_ = Eigen::AngleAxisd(plan_.heading, Vec3::UnitZ()).toRotationMatrix();
  Frame torso_;
  std::ostringstream out_;
};

inline std::string biped_urdf(const BipedPlan& plan) { return BipedUrdf(plan).text(); }

}  // namespace stagger::sim
