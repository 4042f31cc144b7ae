// The robots that are shipped, against the published figures that they were written from.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sim/robot/legs.h"
#include "sim/robot/posture.h"

namespace stagger::sim {
namespace {

using engine::Side;

/// In the nominal pose; stance width is that of the ankles. Roots and limits as published.
struct Figures {
  const char* name;
  double mass;
  double com_height;
  double omega;
  double stance_width;
  double leg_length;
  double sole_length;
  double sole_width;
  double hip_share;
};

void PrintTo(const Figures& figures, std::ostream* out) { *out << figures.name; }

class RobotsTest : public ::testing::TestWithParam<Figures> {
 protected:
  RobotsTest() { body.update(nominal_state(*robot)); }

  std::shared_ptr<const Robot> robot = load_robot(std::string("robots/") + GetParam().name);
  RigidBody body{robot->model};
};

INSTANTIATE_TEST_SUITE_P(
    Shipped, RobotsTest,
    ::testing::Values(Figures{"kasaei", 30.0, 1.0, 3.132, 0.2, 1.0, 0.15, 0.075, 0.84},
                      Figures{"op3", 3.147, 0.267, 6.06, 0.070, 0.220, 0.127, 0.08, 0.96},
                      Figures{"g1", 32.1, 0.677, 3.81, 0.237, 0.637, 0.18, 0.07, 0.96},
                      Figures{"h1_2", 67.0, 0.910, 3.28, 0.326, 0.800, 0.259, 0.085, 0.96}));

TEST_P(RobotsTest, HasItsPublishedFigures) {
  const Figures& figures = GetParam();
  const auto near = [](double value, double wanted) { EXPECT_NEAR(value / wanted, 1.0, 0.01); };
  near(robot->model.mass(), figures.mass);
  near(nominal_com_height(*robot), figures.com_height);
  near(std::sqrt(9.81 / nominal_com_height(*robot)), figures.omega);
  near(leg_length(body, *robot), figures.leg_length);
  near(hip_height(body, *robot) / leg_length(body, *robot), figures.hip_share);
  const auto ankle = [&](Side side) { return body.position(robot->foot_body(side)); };
  near((ankle(Side::left) - ankle(Side::right)).norm(), figures.stance_width);
  for (const FootDescription& foot : robot->description.feet) {
    EXPECT_DOUBLE_EQ(foot.sole.length, figures.sole_length);
    EXPECT_DOUBLE_EQ(foot.sole.width, figures.sole_width);
  }
}

TEST_P(RobotsTest, StandsWithItsComOverTheSolesCentres) {
  EXPECT_NEAR(body.com().x(), 0.0, 1e-4);
  EXPECT_NEAR(body.com().y(), 0.0, 1e-3);  // as far as the published figures are symmetric
}

TEST_P(RobotsTest, LegsAreMirrorImages) {
  const std::vector<int> left = leg_bodies(*robot, Side::left);
  const std::vector<int> right = leg_bodies(*robot, Side::right);
  ASSERT_EQ(left.size(), 6u);
  ASSERT_EQ(right.size(), 6u);
  ASSERT_EQ(robot->model.joint_count(), 12u);
  for (std::size_t i = 0; i < left.size(); ++i) {
    const Body& a = robot->model.bodies[left[i]];
    const Body& b = robot->model.bodies[right[i]];
    EXPECT_EQ(a.mass, b.mass);
    EXPECT_EQ(a.effort, b.effort);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_TRUE(std::isfinite(a.effort) && std::isfinite(a.velocity)) << a.joint;
    const Vec3 com_a = body.pose(left[i]) * a.com;
    const Vec3 com_b = body.pose(right[i]) * b.com;
    EXPECT_LT((com_a - Vec3(com_b.x(), -com_b.y(), com_b.z())).norm(), 1e-4) << a.name;
  }
}

TEST_P(RobotsTest, SolesAreTheBottomsOfTheFootBoxes) {
  for (const Side side : {Side::left, Side::right}) {
    const Body& foot = robot->model.bodies[robot->foot_body(side)];
    ASSERT_EQ(foot.shapes.size(), 1u);
    const Shape& box = foot.shapes[0];
    ASSERT_EQ(box.kind, Shape::Kind::box);
    EXPECT_DOUBLE_EQ(box.size.x(), GetParam().sole_length);
    EXPECT_DOUBLE_EQ(box.size.y(), GetParam().sole_width);
    const Vec3 bottom = box.pose * Vec3(0.0, 0.0, -0.5 * box.size.z());
    EXPECT_LT((bottom - robot->sole_in_body(side).translation()).norm(), 1e-9);
  }
}

bool inside(const Shape& shape, const Vec3& point) {
  switch (shape.kind) {
    case Shape::Kind::box:
      return (point.cwiseAbs() - 0.5 * shape.size).maxCoeff() < 0.0;
    case Shape::Kind::cylinder:
      return point.head<2>().norm() < shape.size.x() && std::abs(point.z()) < 0.5 * shape.size.y();
    case Shape::Kind::sphere:
      return point.norm() < shape.size.x();
    case Shape::Kind::hull:
      break;  // none of these robots has one
  }
  return false;
}

/// Does a point of a fine grid lie inside both?
bool overlap(const Shape& a, const Eigen::Isometry3d& pose_a, const Shape& b,
             const Eigen::Isometry3d& pose_b) {
  constexpr int n = 20;
  const Vec3 half = a.kind == Shape::Kind::box ? Vec3(0.5 * a.size)
                    : a.kind == Shape::Kind::cylinder
                        ? Vec3(a.size.x(), a.size.x(), 0.5 * a.size.y())
                        : Vec3(Vec3::Constant(a.size.x()));
  const Eigen::Isometry3d to_b = (pose_b * b.pose).inverse() * pose_a * a.pose;
  for (int i = -n; i <= n; ++i) {
    for (int j = -n; j <= n; ++j) {
      for (int k = -n; k <= n; ++k) {
        const Vec3 point = Vec3(i, j, k).cwiseProduct(half) / n;
        if (inside(a, point) && inside(b, to_b * point)) return true;
      }
    }
  }
  return false;
}

TEST_P(RobotsTest, CollisionShapesOfDifferentBodiesKeepApart) {
  int shaped = 0;
  for (const RobotState& state : {nominal_state(*robot), walking_state(*robot)}) {
    const auto poses = body_poses(robot->model, state);
    const auto& bodies = robot->model.bodies;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      shaped += bodies[i].shapes.empty() ? 0 : 1;
      for (std::size_t j = 0; j < bodies.size(); ++j) {
        for (const Shape& a : bodies[i].shapes) {
          for (const Shape& b : bodies[j].shapes) {
            if (i == j) continue;
            EXPECT_FALSE(overlap(a, poses[i], b, poses[j])) << bodies[i].name << bodies[j].name;
          }
        }
      }
    }
  }
  EXPECT_EQ(shaped, 2 * 7);  // trunk, and a thigh, a shank and a foot on either side
}

TEST(Robots, KeepTheirPublishedLimits) {
  struct Limit {
    const char* robot;
    const char* joint;
    double lower, upper, effort, velocity;
  };
  const std::vector<Limit> limits = {{"op3", "l_knee", -2.82743339, 2.82743339, 4.1, 4.8},
                                     {"g1", "left_hip_pitch_joint", -2.5307, 2.8798, 88, 32},
                                     {"g1", "right_hip_roll_joint", -2.9671, 0.5236, 139, 20},
                                     {"g1", "left_knee_joint", -0.087267, 2.8798, 139, 20},
                                     {"g1", "left_ankle_pitch_joint", -0.87267, 0.5236, 35, 30},
                                     {"h1_2", "left_hip_yaw_joint", -0.43, 0.43, 200, 23},
                                     {"h1_2", "right_knee_joint", -0.12, 2.19, 300, 14},
                                     {"h1_2", "left_ankle_pitch_joint", -0.897334, 0.523598, 60, 9},
                                     {"h1_2", "left_ankle_roll_joint", -0.261799, 0.261799, 40, 9}};
  for (const Limit& limit : limits) {
    const RobotModel model = load_robot(std::string("robots/") + limit.robot)->model;
    const Body& body = model.bodies[model.joint_index(limit.joint) + 1];
    EXPECT_EQ(body.lower, limit.lower) << limit.joint;
    EXPECT_EQ(body.upper, limit.upper) << limit.joint;
    EXPECT_EQ(body.effort, limit.effort) << limit.joint;
    EXPECT_EQ(body.velocity, limit.velocity) << limit.joint;
  }
}

}  // namespace
}  // namespace stagger::sim
