#include "sim/robot/robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/robot/rigid_body.h"

namespace stagger::sim {
namespace {

using engine::Side;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

/// The folder of the paper's robot with a changed robot.json.
class ChangedRobot {
 public:
  ChangedRobot() {
    // A folder of its own: tests run side by side.
    folder_ =
        std::filesystem::path(::testing::TempDir()) / ("changed_robot_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    std::filesystem::copy_file("robots/kasaei/robot.urdf", folder_ / "robot.urdf",
                               std::filesystem::copy_options::overwrite_existing);
    std::ifstream("robots/kasaei/robot.json") >> description;
  }
  ~ChangedRobot() {
    std::error_code ignored;  // a destructor may not throw
    std::filesystem::remove_all(folder_, ignored);
  }
  ChangedRobot(const ChangedRobot&) = delete;
  ChangedRobot& operator=(const ChangedRobot&) = delete;

  std::string error() const {
    std::ofstream(folder_ / "robot.json") << description.dump(2);
    try {
      load_robot(folder_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  }

  json description;

 private:
  std::filesystem::path folder_;
};

TEST(Kasaei, HasThePapersFigures) {
  const auto robot = load_robot("robots/kasaei");
  EXPECT_EQ(robot->name, "kasaei");
  EXPECT_NEAR(robot->model.mass(), 30.0, 1e-12);
  RigidBody body(robot->model);
  body.update(nominal_state(*robot));
  EXPECT_NEAR(body.com().x(), 0.0, 1e-6);
  EXPECT_NEAR(body.com().y(), 0.0, 1e-12);
  EXPECT_NEAR(body.com().z(), 1.0, 1e-6);
  for (const FootDescription& foot : robot->description.feet) {
    EXPECT_DOUBLE_EQ(foot.sole.length, 0.15);
    EXPECT_DOUBLE_EQ(foot.sole.width, 0.075);
  }
}

TEST(Kasaei, StandsFlatWithItsFeetApart) {
  const auto robot = load_robot("robots/kasaei");
  const auto poses = body_poses(robot->model, nominal_state(*robot));
  for (const Side side : {Side::left, Side::right}) {
    const Eigen::Isometry3d sole = poses[robot->foot_body(side)] * robot->sole_in_body(side);
    const Vec3 expected(0.0, 0.1 * engine::lateral_sign(side), 0.0);
    EXPECT_NEAR((sole.translation() - expected).norm(), 0.0, 1e-12);
    EXPECT_NEAR((sole.linear() - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-12);
  }
}

TEST(Kasaei, SolesAreTheBottomsOfTheFootBoxes) {
  const auto robot = load_robot("robots/kasaei");
  for (const Side side : {Side::left, Side::right}) {
    const Body& foot = robot->model.bodies[robot->foot_body(side)];
    ASSERT_EQ(foot.shapes.size(), 1u);
    const Shape& box = foot.shapes[0];
    EXPECT_EQ(box.kind, Shape::Kind::box);
    EXPECT_DOUBLE_EQ(box.size.x(), 0.15);
    EXPECT_DOUBLE_EQ(box.size.y(), 0.075);
    const Vec3 bottom = box.pose * Vec3(0.0, 0.0, -0.5 * box.size.z());
    EXPECT_NEAR((bottom - robot->sole_in_body(side).translation()).norm(), 0.0, 1e-15);
  }
}

TEST(Kasaei, IsItsOwnMirrorImage) {
  const RobotModel model = load_robot("robots/kasaei")->model;
  ASSERT_EQ(model.joint_count(), 12u);
  for (const char* joint :
       {"hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll"}) {
    const Body& left = model.bodies[model.joint_index(std::string("left_") + joint) + 1];
    const Body& right = model.bodies[model.joint_index(std::string("right_") + joint) + 1];
    EXPECT_EQ(left.mass, right.mass);
    EXPECT_EQ(left.com, right.com);  // all on the mid-line
    EXPECT_EQ(left.inertia, right.inertia);
    EXPECT_EQ(left.effort, right.effort);
    EXPECT_EQ(left.velocity, 15.0);
    const bool sideways = left.axis.y() == 0.0;
    EXPECT_EQ(left.lower, sideways ? -right.upper : right.lower) << joint;
    EXPECT_EQ(left.upper, sideways ? -right.lower : right.upper) << joint;
  }
}

TEST(Kasaei, HasTheStatedEffortLimits) {
  const RobotModel model = load_robot("robots/kasaei")->model;
  const std::vector<std::pair<std::string, double>> efforts = {
      {"left_hip_yaw", 150}, {"left_hip_roll", 150},    {"left_hip_pitch", 150},
      {"left_knee", 200},    {"left_ankle_pitch", 120}, {"left_ankle_roll", 80}};
  for (const auto& [joint, effort] : efforts) {
    EXPECT_EQ(model.bodies[model.joint_index(joint) + 1].effort, effort) << joint;
  }
  double leg = 0.0;
  for (int i = model.links.at("left_foot").body; i > 0; i = model.bodies[i].parent) {
    leg += model.bodies[i].mass;
  }
  EXPECT_NEAR(leg, 6.0, 1e-12);
  EXPECT_EQ(model.links.at("torso").body, 0);
}

TEST(LoadRobot, RefusesUnknownLinksAndJointsByLine) {
  ChangedRobot robot;
  robot.description["base"] = "hips";
  robot.description["feet"]["left"]["link"] = "left_boot";
  robot.description["nominal_pose"]["left_kneee"] = 0.1;
  const std::string error = robot.error();
  EXPECT_THAT(error, HasSubstr("/base is \"hips\", which robot.urdf has no link for; allowed: "));
  EXPECT_THAT(error, HasSubstr("/feet/left/link is \"left_boot\""));
  EXPECT_THAT(error, HasSubstr("/nominal_pose/left_kneee is no joint of robot.urdf; allowed: "));
  EXPECT_THAT(error, HasSubstr("robot.json:2: /base"));
}

TEST(LoadRobot, RefusesNumbersOutOfRange) {
  ChangedRobot robot;
  robot.description["walk"]["t_ss_s"] = 0.0;
  robot.description["feet"]["right"]["sole"]["length"] = -1;
  robot.description["colour"] = "red";
  const std::string error = robot.error();
  EXPECT_THAT(error, HasSubstr("/walk/t_ss_s is 0.0; allowed: 0.1 to 3 s"));
  EXPECT_THAT(error, HasSubstr("/feet/right/sole/length is -1; allowed: 0.02 to 1 m"));
  EXPECT_THAT(error, HasSubstr("/colour is no field here"));
}

TEST(LoadRobot, RefusesAStepWidthThatLeavesNoGapBetweenTheSoles) {
  ChangedRobot robot;
  robot.description["walk"]["min_step_width_m"] = 0.08;
  EXPECT_THAT(robot.error(),
              HasSubstr("/walk/min_step_width_m is 0.08 m, which leaves no gap between the soles"));
}

TEST(LoadRobot, RefusesAPoseThatCannotBeStoodIn) {
  ChangedRobot robot;
  robot.description["nominal_pose"]["left_knee"] = 3.0;
  EXPECT_THAT(robot.error(), HasSubstr("/nominal_pose/left_knee is 3; allowed: 0 to 2.4 rad"));
  robot.description["nominal_pose"]["left_knee"] = 1.0;
  EXPECT_THAT(robot.error(), HasSubstr("/nominal_pose puts the right sole"));
}

TEST(LoadRobot, RefusesFeetThatAreNoFeet) {
  ChangedRobot robot;
  robot.description["feet"]["right"]["link"] = "left_foot";
  EXPECT_THAT(robot.error(), HasSubstr("is part of the left foot's body"));
  robot.description["feet"]["right"]["link"] = "right_shank";
  EXPECT_THAT(robot.error(), HasSubstr("is carried by 4 joints; allowed: a leg of at least 5"));
}

TEST(LoadRobot, StaysInsideTheFolder) {
  ChangedRobot robot;
  robot.description["urdf"] = "../kasaei/robot.urdf";
  EXPECT_THAT(robot.error(), HasSubstr("allowed: a file beside robot.json"));
}

TEST(ListRobots, FindsThemSorted) {
  EXPECT_THAT(list_robots("robots"),
              AllOf(Contains("kasaei"), ::testing::WhenSorted(list_robots("robots"))));
  EXPECT_TRUE(list_robots("no/such/folder").empty());
}

}  // namespace
}  // namespace stagger::sim
