#include "sim/robot/urdf_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace stagger::sim {
namespace {

using ::testing::HasSubstr;

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string inertial(double mass, const std::string& xyz = "0 0 0",
                     const std::string& rpy = "0 0 0",
                     const std::string& moments = R"(ixx="0.1" iyy="0.2" izz="0.25")") {
  return R"(<inertial><origin xyz=")" + xyz + R"(" rpy=")" + rpy + R"("/><mass value=")" +
         std::to_string(mass) + R"("/><inertia ixy="0" ixz="0" iyz="0" )" + moments +
         "/></inertial>";
}

std::string link(const std::string& name, const std::string& inside) {
  return "<link name=\"" + name + "\">" + inside + "</link>";
}

std::string joint(const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& inside) {
  return "<joint name=\"" + parent + "_" + child + "\" type=\"" + type + "\"><parent link=\"" +
         parent + "\"/><child link=\"" + child + "\"/>" + inside + "</joint>";
}

std::string robot(const std::string& inside) {
  return "<?xml version=\"1.0\"?><robot name=\"test\">" + inside + "</robot>";
}

const char* const plain_limit = R"(<limit lower="-1" upper="2" effort="30" velocity="4"/>)";

std::string two_links(const std::string& type, const std::string& joint_inside) {
  return robot(link("a", inertial(2)) + link("b", inertial(1)) +
               joint(type, "a", "b", joint_inside));
}

std::string error_of(const std::string& xml) {
  try {
    import_urdf(xml, "test.urdf");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(UrdfImport, LinksOnFixedJointsBecomeOneBody) {
  // Two boxes of 2 kg and 1 kg; the second sits 0.3 m ahead, turned by 90 degrees about z.
  const RobotModel model = import_urdf(
      robot(link("a", inertial(2, "0 0 0.1")) + link("b", inertial(1)) +
            joint("fixed", "a", "b", R"(<origin xyz="0.3 0 0.1" rpy="0 0 1.5707963267948966"/>)")),
      "test.urdf");
  ASSERT_EQ(model.bodies.size(), 1u);
  const Body& body = model.bodies[0];
  EXPECT_DOUBLE_EQ(body.mass, 3.0);
  EXPECT_NEAR((body.com - Vec3(0.1, 0.0, 0.1)).norm(), 0.0, 1e-15);
  // Steiner: 2 kg at 0.1 m and 1 kg at 0.2 m along x; the turned box swaps its x and y moments.
  const double steiner = 2.0 * 0.1 * 0.1 + 1.0 * 0.2 * 0.2;
  const Vec3 moments(0.1 + 0.2, 0.2 + 0.1 + steiner, 0.25 + 0.25 + steiner);
  EXPECT_NEAR((body.inertia - Eigen::Matrix3d(moments.asDiagonal())).norm(), 0.0, 1e-15);

  const LinkPlace& b = model.links.at("b");
  EXPECT_EQ(b.body, 0);
  EXPECT_DOUBLE_EQ(b.mass, 1.0);
  EXPECT_NEAR((b.pose * Vec3(0.0, 1.0, 0.0) - Vec3(-0.7, 0.0, 0.1)).norm(), 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(model.links.at("a").com.z(), 0.1);
}

TEST(UrdfImport, TurnedInertialFrameTurnsTheInertia) {
  const RobotModel model =
      import_urdf(robot(link("a", inertial(2, "0 0 0", "1.5707963267948966 0 0"))), "test.urdf");
  const Vec3 moments(0.1, 0.25, 0.2);  // a quarter turn about x swaps y and z
  EXPECT_NEAR((model.bodies[0].inertia - Eigen::Matrix3d(moments.asDiagonal())).norm(), 0.0, 1e-15);
}

TEST(UrdfImport, FixedLinksBetweenJointsCarryThePlacement) {
  const RobotModel model = import_urdf(
      robot(link("a", inertial(2)) + link("mount", "") + link("b", inertial(1)) +
            joint("fixed", "a", "mount", R"(<origin xyz="0 0 0.5"/>)") +
            joint("revolute", "mount", "b",
                  std::string(R"(<origin xyz="0.1 0 0"/><axis xyz="0 2 0"/>)") + plain_limit)),
      "test.urdf");
  ASSERT_EQ(model.bodies.size(), 2u);
  const Body& body = model.bodies[1];
  EXPECT_EQ(body.parent, 0);
  EXPECT_EQ(body.joint, "mount_b");
  EXPECT_EQ(body.placement.translation(), Vec3(0.1, 0.0, 0.5));
  EXPECT_EQ(body.axis, Vec3::UnitY());
  EXPECT_EQ(body.lower, -1.0);
  EXPECT_EQ(body.upper, 2.0);
  EXPECT_EQ(body.effort, 30.0);
  EXPECT_EQ(body.velocity, 4.0);
  EXPECT_EQ(model.links.at("mount").mass, 0.0);
  EXPECT_EQ(model.joint_names(), std::vector<std::string>{"mount_b"});
  EXPECT_EQ(model.joint_index("mount_b"), 0);
  EXPECT_EQ(model.joint_index("b"), -1);
}

TEST(UrdfImport, ParentsComeBeforeChildren) {
  std::string xml;
  for (const char* name : {"a", "z", "m", "b"}) xml += link(name, inertial(1));
  xml += joint("revolute", "a", "z", plain_limit) + joint("revolute", "z", "b", plain_limit) +
         joint("revolute", "b", "m", plain_limit);
  const RobotModel model = import_urdf(robot(xml), "test.urdf");
  ASSERT_EQ(model.bodies.size(), 4u);
  for (int i = 1; i < 4; ++i) EXPECT_LT(model.bodies[i].parent, i);
  EXPECT_EQ(model.bodies[3].name, "m");
  EXPECT_DOUBLE_EQ(model.mass(), 4.0);
}

TEST(UrdfImport, MissingBoundsMeanUnlimited) {
  const Body revolute =
      import_urdf(two_links("revolute", R"(<limit effort="5" velocity="1"/>)"), "test.urdf")
          .bodies[1];
  EXPECT_EQ(revolute.lower, -infinity);
  EXPECT_EQ(revolute.upper, infinity);
  EXPECT_EQ(revolute.effort, 5.0);
  const Body continuous = import_urdf(two_links("continuous", ""), "test.urdf").bodies[1];
  EXPECT_EQ(continuous.lower, -infinity);
  EXPECT_EQ(continuous.upper, infinity);
  EXPECT_EQ(continuous.effort, infinity);
}

TEST(UrdfImport, ShapesStandInTheBodysFrame) {
  const RobotModel model = import_urdf(
      robot(link("a", inertial(1)) +
            link("b", R"(<collision><origin xyz="0 0 0.1"/><geometry><box size="1 2 3"/></geometry>
                      </collision><collision><geometry><cylinder radius="0.2" length="0.5"/>
                      </geometry></collision><collision><geometry><sphere radius="0.3"/></geometry>
                      </collision>)") +
            joint("fixed", "a", "b", R"(<origin xyz="1 0 0"/>)")),
      "test.urdf");
  const std::vector<Shape>& shapes = model.bodies[0].shapes;
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(shapes[0].kind, Shape::Kind::box);
  EXPECT_EQ(shapes[0].size, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(shapes[0].pose.translation(), Vec3(1.0, 0.0, 0.1));
  EXPECT_EQ(shapes[1].kind, Shape::Kind::cylinder);
  EXPECT_EQ(shapes[1].size.head<2>(), engine::Vec2(0.2, 0.5));
  EXPECT_EQ(shapes[2].kind, Shape::Kind::sphere);
  EXPECT_EQ(shapes[2].size.x(), 0.3);
}

TEST(UrdfImport, RefusesJointsThatDoNotTurn) {
  for (const char* type : {"prismatic", "planar", "floating"}) {
    const std::string error =
        error_of(two_links(type, R"(<limit lower="0" upper="1" effort="1" velocity="1"/>)"));
    EXPECT_THAT(error, HasSubstr("test.urdf"));
    EXPECT_THAT(error, HasSubstr("'a_b'"));
    EXPECT_THAT(error, HasSubstr(type));
    EXPECT_THAT(error, HasSubstr("allowed: revolute"));
  }
}

TEST(UrdfImport, RefusesBodiesThatCannotMove) {
  const auto with_child = [](const std::string& inside) {
    return error_of(robot(link("a", inertial(2)) + link("b", inside) +
                          joint("revolute", "a", "b", plain_limit)));
  };
  EXPECT_THAT(with_child(""), HasSubstr("'b' (with all that is fixed to it): mass is 0 kg"));
  EXPECT_THAT(with_child(inertial(-1)), HasSubstr("mass is -1"));
  EXPECT_THAT(with_child(inertial(1, "0 0 0", "0 0 0", R"(ixx="0" iyy="0" izz="0")")),
              HasSubstr("principal moments of inertia are"));
  EXPECT_THAT(with_child(inertial(1, "0 0 0", "0 0 0", R"(ixx="0.1" iyy="-0.1" izz="0.1")")),
              HasSubstr("principal moments of inertia are"));
}

TEST(UrdfImport, RefusesWhatItWouldSimulateWrongly) {
  EXPECT_THAT(error_of(robot(link("a", inertial(1) + R"(<collision><geometry>
                      <mesh filename="foot.stl"/></geometry></collision>)"))),
              HasSubstr("link 'a': there is no file for its mesh foot.stl"));
  EXPECT_THAT(
      error_of(two_links("revolute", std::string(R"(<mimic joint="other"/>)") + plain_limit)),
      HasSubstr("mimics 'other'"));
  EXPECT_THAT(error_of(robot(link("a", inertial(1) + R"(<collision><geometry><sphere radius="0"/>
                      </geometry></collision>)"))),
              HasSubstr("size of its collision geometry is 0 m; allowed: more than 0 m"));
  EXPECT_THAT(error_of("<robot"), HasSubstr("test.urdf: is no URDF"));
  EXPECT_THAT(error_of(robot("")), HasSubstr("test.urdf: is no URDF"));
}

TEST(UrdfImport, LockedJointsHoldTheirLinksWhereTheyAreLocked) {
  ImportOptions options;
  options.locked["a_b"] = 0.5 * M_PI;
  const RobotModel model =
      import_urdf(two_links("revolute", std::string(R"(<origin xyz="1 0 0"/><axis xyz="0 0 1"/>)") +
                                            plain_limit),
                  "test.urdf", options);
  ASSERT_EQ(model.bodies.size(), 1u);
  EXPECT_DOUBLE_EQ(model.mass(), 3.0);
  EXPECT_LT((model.links.at("b").pose * Vec3::UnitX() - Vec3(1.0, 1.0, 0.0)).norm(), 1e-12);
  options.locked["nobody"] = 0.0;
  EXPECT_THAT([&] { import_urdf(two_links("revolute", plain_limit), "test.urdf", options); },
              ::testing::ThrowsMessage<std::runtime_error>(
                  HasSubstr("has no joint 'nobody', which is to be locked")));
}

TEST(UrdfImport, ALockedJointMayMimicAnother) {
  ImportOptions options;
  options.locked["a_b"] = 0.0;
  const std::string mimic = std::string(R"(<mimic joint="other"/>)") + plain_limit;
  EXPECT_EQ(import_urdf(two_links("revolute", mimic), "test.urdf", options).bodies.size(), 1u);
}

TEST(UrdfImport, MotorLimitsReplaceThoseOfTheFile) {
  ImportOptions options;
  options.motors["a_b"].effort = 7.0;
  const RobotModel model = import_urdf(two_links("revolute", plain_limit), "test.urdf", options);
  EXPECT_EQ(model.bodies[1].effort, 7.0);
  EXPECT_EQ(model.bodies[1].velocity, 4.0);
}

TEST(UrdfImport, MendsWhatItIsToldToMend) {
  ImportOptions options;
  options.mode = ImportMode::mend;
  ImportReport report;
  const std::string shapes = R"(<collision><geometry><sphere radius="0"/></geometry></collision>
      <collision><geometry><mesh filename="foot.stl"/></geometry></collision>)";
  const RobotModel model = import_urdf(
      robot(link("a", inertial(2)) + link("b", shapes) +
            link("c", inertial(1, "0 0 0", "0 0 0", R"(ixx="0.1" iyy="0" izz="0.9")")) +
            joint("revolute", "a", "b", plain_limit) + joint("revolute", "b", "c", plain_limit)),
      "test.urdf", options, &report);
  EXPECT_DOUBLE_EQ(model.bodies[1].mass, 0.003);
  ASSERT_EQ(model.bodies[1].shapes.size(), 1u);
  EXPECT_GT(model.bodies[1].shapes[0].size.x(), 0.0);
  // None of the moments is above the sum of the others, and none is 0.
  const Vec3 moments = model.bodies[2].inertia.diagonal();
  EXPECT_GT(moments.minCoeff(), 0.0);
  EXPECT_LE(2.0 * moments.maxCoeff(), moments.sum() * (1.0 + 1e-12));
  EXPECT_EQ(report.mended.size(), 2u);
  EXPECT_GE(report.quirks.size(), 3u);
}

TEST(UrdfImport, VisualMeshesAreNobodysBusiness) {
  EXPECT_EQ(error_of(robot(link("a", inertial(1) + R"(<visual><geometry><mesh filename="x.stl"/>
                      </geometry></visual>)"))),
            "no error");
}

TEST(UrdfImport, NamesTheFileThatIsMissing) {
  EXPECT_THAT([] { import_urdf_file("robots/nobody/robot.urdf"); },
              ::testing::ThrowsMessage<std::runtime_error>(
                  HasSubstr("robots/nobody/robot.urdf: cannot be opened")));
}

}  // namespace
}  // namespace stagger::sim
