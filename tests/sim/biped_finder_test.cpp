#include "sim/robot/biped_finder.h"

#include <gmock/gmock.h>

#include <random>

#include "found_biped.h"
#include "sim/robot/rigid_body.h"

namespace stagger::sim {
namespace {

using engine::Side;
using Foot = BipedPlan::Foot;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;

std::vector<LegRole> roles(const Leg& leg) {
  std::vector<LegRole> result;
  for (const LegJoint& joint : leg.joints) result.push_back(joint.role);
  return result;
}

/// The soles are level, side by side, ahead; the torso is upright; the CoM is over their middle.
void expect_standing(const Robot& robot) {
  RigidBody body(robot.model);
  body.update(nominal_state(robot));
  for (const Side side : {Side::left, Side::right}) {
    const Eigen::Isometry3d sole = body.pose(robot.foot_body(side)) * robot.sole_in_body(side);
    EXPECT_NEAR(sole.translation().z(), 0.0, 1e-5);
    EXPECT_GT(sole.translation().y() * engine::lateral_sign(side), 0.0);
    EXPECT_LT((sole.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-4) << sole.linear();
  }
  const int torso = robot.model.links.at(robot.description.torso).body;
  const Eigen::Matrix3d upright = body.rotation(torso) * robot.torso_in_body();
  EXPECT_LT((upright - Eigen::Matrix3d::Identity()).norm(), 1e-4) << upright;
  EXPECT_NEAR(body.com().x(), 0.0, 1e-4);
  // It walks with its knees bent further.
  EXPECT_LE(robot.description.walk.com_height_m, body.com().z() + 1e-3);
  EXPECT_GT(robot.description.walk.com_height_m, 0.8 * body.com().z());
}

void expect_sole(const BipedFinding& found, double length, double width) {
  for (const FootDescription& foot : found.robot.description.feet) {
    EXPECT_NEAR(foot.sole.length, length, 1e-4);
    EXPECT_NEAR(foot.sole.width, width, 1e-4);
  }
}

TEST(FindBiped, FindsThePapersRobotAsItIsDescribedByHand) {
  const BipedFinding found = find_biped("robots/kasaei/robot.urdf");
  const auto by_hand = load_robot("robots/kasaei");
  const BipedDescription& d = found.robot.description;
  EXPECT_EQ(d.base, "pelvis");
  EXPECT_EQ(d.torso, "torso");
  for (const Side side : {Side::left, Side::right}) {
    const FootDescription& foot = d.feet[index(side)];
    const FootDescription& expected = by_hand->description.feet[index(side)];
    EXPECT_EQ(foot.link, expected.link);
    EXPECT_LT((foot.sole.position - expected.sole.position).norm(), 1e-9);
    EXPECT_TRUE(foot.sole.rpy.isZero());
    EXPECT_NEAR(foot.sole.length, expected.sole.length, 1e-9);
    EXPECT_NEAR(foot.sole.width, expected.sole.width, 1e-9);
  }
  EXPECT_TRUE(found.quirks.empty());
  EXPECT_NEAR(found.figures.mass, 30.0, 1e-12);
  EXPECT_NEAR(found.figures.leg_length, 1.0, 1e-4);
  EXPECT_NEAR(found.figures.stance_width, 0.2, 1e-6);
  // 120 N m over 294 N are more than the sole is long, 80 N m more than it is wide.
  EXPECT_NEAR(found.figures.ankle_ahead, 0.075, 1e-6);
  EXPECT_NEAR(found.figures.ankle_outward, 0.0375, 1e-6);
  expect_standing(found.robot);
}

TEST(FindBiped, RolesComeFromTheWorldWhateverTheOrderTheSignsAndTheFrames) {
  const std::map<char, LegRole> hips = {
      {'Y', LegRole::hip_yaw}, {'R', LegRole::hip_roll}, {'P', LegRole::hip_pitch}};
  const std::map<char, LegRole> ankles = {{'R', LegRole::ankle_roll}, {'P', LegRole::ankle_pitch}};
  for (const char* hip : {"YRP", "PRY", "RYP", "YPR"}) {
    for (const char* ankle : {"PR", "RP"}) {
      for (const bool z_axes : {false, true}) {
        BipedPlan plan;
        plan.hip = hip;
        plan.ankle = ankle;
        plan.z_axes = z_axes;
        plan.mirrored = z_axes;
        const BipedFinding found = find_plan(plan);
        std::vector<LegRole> expected;
        for (const char c : plan.hip) expected.push_back(hips.at(c));
        expected.push_back(LegRole::knee);
        for (const char c : plan.ankle) expected.push_back(ankles.at(c));
        for (const Leg& leg : found.legs.leg) EXPECT_EQ(roles(leg), expected) << hip << ankle;
        EXPECT_THAT(found.legs.leg[0].joints[0].name, HasSubstr("left"));
        EXPECT_NEAR(found.figures.leg_length, plan.leg, 1e-3);
        expect_sole(found, 0.24 * plan.leg, 0.12 * plan.leg);
        expect_standing(found.robot);
      }
    }
  }
}

TEST(FindBiped, LooksTheWayItsSidesSay) {
  for (const double heading : {0.0, M_PI, 0.5 * M_PI, -0.5 * M_PI, 0.3}) {
    BipedPlan plan;
    plan.heading = heading;
    const BipedFinding found = find_plan(plan);
    EXPECT_LT((found.legs.axes.col(0) - Vec3(std::cos(heading), std::sin(heading), 0.0)).norm(),
              1e-6)
        << heading;
    expect_standing(found.robot);
  }
}

TEST(FindBiped, WithoutNamesTheKneesTellWhichWayIsAhead) {
  BipedPlan plan;
  plan.heading = M_PI;
  std::string urdf = biped_urdf(plan);
  for (const auto& [side, other] : {std::pair("left_", "a_"), std::pair("right_", "b_")}) {
    for (auto at = urdf.find(side); at != std::string::npos; at = urdf.find(side)) {
      urdf.replace(at, std::string(side).size(), other);
    }
  }
  const BipedFinding found = find_text(urdf);
  EXPECT_NEAR(found.legs.axes(0, 0), -1.0, 1e-9);
  EXPECT_THAT(found.legs.leg[0].foot, HasSubstr("a_"));
  expect_standing(found.robot);
}

TEST(FindBiped, FindsEveryKindOfSole) {
  for (const Foot foot : {Foot::box, Foot::spheres, Foot::cylinders, Foot::two_boxes}) {
    BipedPlan plan;
    plan.foot = foot;
    const BipedFinding found = find_plan(plan);
    expect_sole(found, 0.24 * plan.leg, 0.12 * plan.leg);
    const SoleDescription& sole = found.robot.description.feet[0].sole;
    EXPECT_NEAR(sole.position.z(), -0.08 * plan.leg, 1e-5);
    EXPECT_NEAR(sole.position.x(), 0.24 * 0.2 * plan.leg, 1e-5);
    EXPECT_NEAR(found.figures.ankle_ahead, (0.12 + 0.24 * 0.2) * plan.leg, 1e-4);
    EXPECT_NEAR(found.figures.ankle_behind, (0.12 - 0.24 * 0.2) * plan.leg, 1e-4);
  }
  BipedPlan plan;
  plan.foot = Foot::points;  // spheres without a radius count as 1 mm
  EXPECT_NEAR(find_plan(plan).robot.description.feet[0].sole.position.z(), -0.08 * plan.leg - 1e-3,
              1e-5);
}

TEST(FindBiped, FlattensAFootThatIsTiltedAtTheZeroPose) {
  BipedPlan plan;
  plan.foot_tilt = 0.1745;
  for (const Foot foot : {Foot::box, Foot::spheres, Foot::cylinders}) {
    plan.foot = foot;
    const BipedFinding found = find_plan(plan);
    expect_sole(found, 0.24 * plan.leg, 0.12 * plan.leg);
    EXPECT_THAT(found.quirks, Contains(Field(&Quirk::what, HasSubstr("tilted by 0.1745 rad"))));
    expect_standing(found.robot);
  }
}

TEST(FindBiped, ShipsWithItsMeshesAndComesBackTheSame) {
  const BipedFinding found = find_biped("tests/data/robots/waist_and_arms.urdf");
  ASSERT_EQ(found.meshes.size(), 1U);
  // The mesh is 240 mm x 120 mm with its corners cut, at 0.6 of its size.
  const SoleDescription& sole = found.robot.description.feet[0].sole;
  EXPECT_GT(sole.length, 0.85 * 0.144);
  EXPECT_LE(sole.length, 0.144 + 1e-6);
  EXPECT_GT(sole.width, 0.75 * 0.072);
  EXPECT_LE(sole.width, 0.072 + 1e-6);
  const auto back = written_robot(std::filesystem::path("tests/data/robots/waist_and_arms.urdf"));
  EXPECT_EQ(back->model.joint_count(), 12U);
  EXPECT_EQ(description_json(back->description), description_json(found.robot.description));
  const auto& shapes =
      back->model.bodies[static_cast<std::size_t>(back->foot_body(Side::left))].shapes;
  ASSERT_EQ(shapes.size(), 1U);
  EXPECT_EQ(shapes[0].kind, Shape::Kind::hull);
  EXPECT_LE(shapes[0].points.size(), 32U);
  expect_standing(*back);
}

TEST(FindBiped, LocksWhatIsNoLegAtZeroOrAsNearAsItsRangeLets) {
  BipedPlan plan;
  plan.waist = true;
  plan.arms = true;
  const BipedFinding found = find_plan(plan);
  const BipedDescription& d = found.robot.description;
  EXPECT_EQ(d.base, "waist_yaw_link");
  EXPECT_EQ(d.torso, "trunk");
  EXPECT_EQ(d.locked.size(), 5U);
  EXPECT_EQ(d.locked.at("waist_yaw"), 0.0);
  EXPECT_DOUBLE_EQ(d.locked.at("left_shoulder"), 0.1);
  EXPECT_DOUBLE_EQ(d.locked.at("right_shoulder"), -0.1);
  EXPECT_EQ(found.robot.model.joint_count(), 12U);
  EXPECT_THAT(found.quirks, Contains(Field(&Quirk::what, HasSubstr("both legs hang off it"))));
  EXPECT_THAT(found.quirks, Contains(Field(&Quirk::what, HasSubstr("leaves out zero"))));
  expect_standing(found.robot);
}

TEST(FindBiped, ARootWithoutMassOnAFloatingJointIsNoObstacle) {
  BipedPlan plan;
  plan.world = true;
  const BipedFinding found = find_plan(plan);
  EXPECT_THAT(found.quirks, Contains(Field(&Quirk::what, HasSubstr("floats below a root"))));
  expect_standing(*written_robot(plan));
}

TEST(FindBiped, BoundsThatAreMissingMeanNone) {
  BipedPlan plan;
  plan.limits = false;
  const BipedFinding found = find_plan(plan);
  EXPECT_TRUE(std::isinf(found.robot.model.bodies[1].upper));
  EXPECT_THAT(found.quirks, Contains(Field(&Quirk::what, HasSubstr("lower is not less"))));
  expect_standing(found.robot);
}

TEST(FindBiped, TorqueLimitsThatCannotBeTrueAreReplacedByAStatedAssumption) {
  for (const double effort : {0.0, 1000.0}) {
    BipedPlan plan;
    plan.effort = effort;
    const BipedFinding found = find_plan(plan);
    const auto& motors = found.robot.description.motors;
    ASSERT_EQ(motors.size(), 12U) << effort;
    const double scale = found.figures.mass * 9.81 * plan.leg;
    EXPECT_NEAR(motors.at("left_knee").effort.value_or(0.0), 0.7 * scale, 0.1);
    EXPECT_THAT(found.quirks, Contains(Field(&Quirk::answer, HasSubstr("ASSUMED"))));
    // The way through the file keeps it.
    const auto back = written_robot(plan);
    const int knee = back->model.joint_index("left_knee") + 1;
    EXPECT_NEAR(back->model.bodies[static_cast<std::size_t>(knee)].effort, 0.7 * scale, 0.1);
  }
}

TEST(FindBiped, TellsWhatTheAnkleCannotHold) {
  BipedPlan plan;
  plan.effort = 0.1;
  const BipedFinding found = find_plan(plan);
  // 0.1 * 0.4 of m g l, by the plan's mass; the sole's edge would be farther.
  EXPECT_NEAR(found.figures.ankle_ahead, 0.1 * 0.4 * plan.leg * plan.mass / found.figures.mass,
              1e-6);
  EXPECT_THAT(found.quirks, Contains(Field(&Quirk::where, "ankle pitch")));
}

TEST(FindBiped, FiveJointsALegAreEnough) {
  BipedPlan plan;
  plan.ankle = "P";
  EXPECT_THAT(find_plan(plan).quirks, Contains(Field(&Quirk::what, "no ankle roll joint")));
  expect_standing(find_plan(plan).robot);
  plan = {};
  plan.hip = "RP";
  EXPECT_THAT(find_plan(plan).quirks, Contains(Field(&Quirk::what, "no hip yaw joint")));
  expect_standing(find_plan(plan).robot);
}

TEST(FindBiped, FindsRandomBipeds) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto coin = [&] { return between(0.0, 1.0) < 0.5; };
  const char* orders[] = {"YRP", "YPR", "RYP", "RPY", "PRY", "PYR"};
  for (int i = 0; i < 40; ++i) {
    BipedPlan plan;
    plan.mass = between(5.0, 60.0);
    plan.leg = between(0.3, 1.0);
    plan.hip = orders[static_cast<int>(between(0.0, 5.999))];
    plan.ankle = coin() ? "PR" : "RP";
    plan.hip_offset = between(0.0, 0.05);
    plan.hip_tilt = between(-0.5, 0.5);
    plan.heading = between(-3.0, 3.0);
    plan.foot_tilt = between(-0.2, 0.2);
    plan.foot_shift = between(-0.3, 0.3);
    plan.z_axes = coin();
    plan.mirrored = coin();
    plan.waist = coin();
    plan.foot = static_cast<Foot>(static_cast<int>(between(0.0, 3.999)));
    const BipedFinding found = find_plan(plan);
    SCOPED_TRACE(i);
    EXPECT_EQ(found.robot.model.joint_count(), 12U);
    EXPECT_NEAR(found.robot.description.feet[0].sole.length, 0.24 * plan.leg, 1e-3);
    EXPECT_NEAR(found.robot.description.feet[0].sole.width, 0.12 * plan.leg, 1e-3);
    expect_standing(found.robot);
  }
}

}  // namespace
}  // namespace stagger::sim
