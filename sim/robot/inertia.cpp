#include "sim/robot/inertia.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <sstream>

namespace stagger::sim {
namespace {

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

/// Of the robot's mass, what a body without any gets.
constexpr double least_mass_share = 1e-3;
constexpr double water = 1000.0;  // [kg/m^3]
/// Figures of files are rounded: the triangle inequality may be missed by this share.
constexpr double triangle_tolerance = 1e-3;

/// Steiner's theorem: inertia about a point displaced by d from the centre of mass.
Eigen::Matrix3d displaced(const Eigen::Matrix3d& inertia, double mass, const Vec3& d) {
  return inertia + mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
}

/// Of a cube of water about its centre [kg m^2].
double cube_moment(double mass) {
  const double edge = std::cbrt(mass / water);
  return mass * edge * edge / 6.0;
}

std::string as_text(const Vec3& moments) {
  std::ostringstream text;
  text << "principal moments of inertia are [" << moments.transpose() << "] kg m^2";
  return text.str();
}

}  // namespace

void add_mass(Body& body, double mass, const Vec3& com, const Eigen::Matrix3d& inertia) {
  const double sum = body.mass + mass;
  const Vec3 joint_com = sum > 0.0 ? Vec3((body.mass * body.com + mass * com) / sum) : Vec3::Zero();
  body.inertia = displaced(body.inertia, body.mass, body.com - joint_com) +
                 displaced(inertia, mass, com - joint_com);
  body.com = joint_com;
  body.mass = sum;
}

std::string inertia_fault(const Eigen::Matrix3d& inertia) {
  const Vec3 moments = Solver(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(moments[0] > 0.0)) return as_text(moments) + "; allowed: more than 0 kg m^2 each";
  if (moments[2] > (moments[0] + moments[1]) * (1.0 + triangle_tolerance)) {
    return as_text(moments) + "; allowed: none greater than the sum of the others";
  }
  return {};
}

Quirks mend_masses(RobotModel& model) {
  Quirks quirks;
  const double total = model.mass();
  if (!(total > 0.0)) return quirks;
  for (Body& body : model.bodies) {
    const std::string who = "body '" + body.name + "'";
    if (!(body.mass > 0.0)) {
      body.mass = least_mass_share * total;
      body.inertia = cube_moment(body.mass) * Eigen::Matrix3d::Identity();
      std::ostringstream answer;
      answer << "given " << body.mass << " kg, a thousandth of the robot's mass";
      quirks.push_back({who, "moves, and has no mass", answer.str()});
      continue;
    }
    const std::string fault = inertia_fault(body.inertia);
    if (fault.empty()) continue;
    const Solver solver(body.inertia);
    Vec3 moments = solver.eigenvalues();  // rising
    if (!(moments[0] > 0.0)) moments = moments.cwiseMax(cube_moment(body.mass));
    const double excess = moments.maxCoeff() - (moments.sum() - moments.maxCoeff());
    if (excess > 0.0) {
      Eigen::Index greatest = 0;
      moments.maxCoeff(&greatest);
      for (Eigen::Index i = 0; i < 3; ++i) {
        if (i != greatest) moments[i] += 0.5 * excess;
      }
    }
    body.inertia = solver.eigenvectors() * moments.asDiagonal() * solver.eigenvectors().transpose();
    std::ostringstream answer;
    answer << "raised to [" << moments.transpose() << "] kg m^2";
    quirks.push_back({who, fault, answer.str()});
  }
  return quirks;
}

}  // namespace stagger::sim
