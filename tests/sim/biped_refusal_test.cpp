// What is no biped, no robot, or no URDF: a clear reason, and never a crash.
#include <gmock/gmock.h>

#include <random>

#include "found_biped.h"

namespace stagger::sim {
namespace {

using Foot = BipedPlan::Foot;
using ::testing::HasSubstr;

/// The reason that it cannot walk.
std::string refusal(const std::string& urdf) {
  try {
    find_text(urdf);
  } catch (const CannotWalk& error) {
    return error.what();
  }
  return "no refusal";
}

std::string error(const std::string& urdf) {
  try {
    find_text(urdf);
  } catch (const CannotWalk& wrong) {
    return std::string("walks not: ") + wrong.what();
  } catch (const std::runtime_error& expected) {
    return expected.what();
  }
  return "no error";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(RefuseBiped, PointFeet) {
  BipedPlan plan;
  plan.foot = Foot::ball;
  EXPECT_THAT(refusal(biped_urdf(plan)), HasSubstr("touches the ground in a point or a line"));
}

TEST(RefuseBiped, FeetWithoutGeometry) {
  BipedPlan plan;
  plan.foot = Foot::none;
  EXPECT_THAT(refusal(biped_urdf(plan)), HasSubstr("has no collision geometry"));
  plan.foot = Foot::mesh;
  plan.mesh = "package://nowhere/foot.stl";
  const std::string reason = refusal(biped_urdf(plan));
  EXPECT_THAT(reason, HasSubstr("has no collision geometry"));
  EXPECT_THAT(reason, HasSubstr("there is no file for its mesh package://nowhere/foot.stl"));
}

TEST(RefuseBiped, FourJointsALeg) {
  BipedPlan plan;
  plan.hip = "P";
  EXPECT_THAT(refusal(biped_urdf(plan)), HasSubstr("has 4 joints of its own; allowed: at least 5"));
}

TEST(RefuseBiped, PassiveJointsOfClosedLoops) {
  std::string urdf = biped_urdf({});
  const auto knee = urdf.find("\"left_knee\"");
  const auto effort = urdf.find("effort=\"", knee) + 8;
  urdf.replace(effort, urdf.find('"', effort) - effort, "0");
  EXPECT_THAT(refusal(urdf), HasSubstr("'left_knee'; passive joints belong to closed loops"));
}

TEST(RefuseBiped, LegsThatSlide) {
  const std::string urdf = replaced(biped_urdf({}), "\"left_knee\" type=\"revolute\"",
                                    "\"left_knee\" type=\"prismatic\"");
  EXPECT_THAT(refusal(urdf), HasSubstr("has the prismatic joint 'left_knee'"));
}

TEST(RefuseBiped, WhatHasNotTwoLegs) {
  EXPECT_THAT(refusal(R"(<robot name="a"><link name="b"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)"),
              HasSubstr("it has 0 ends of movable chains"));
}

TEST(RefuseBiped, WhatWeighsNothing) {
  EXPECT_THAT(error(R"(<robot name="a"><link name="b"/></robot>)"),
              HasSubstr("no link has a mass"));
}

TEST(BrokenUrdf, TreesThatAreNone) {
  const auto two = [](const std::string& joints) {
    return R"(<robot name="a"><link name="r"/><link name="x"/><link name="y"/>)" + joints +
           "</robot>";
  };
  const auto joint = [](const std::string& name, const std::string& from, const std::string& to) {
    return "<joint name=\"" + name + "\" type=\"fixed\"><parent link=\"" + from +
           "\"/><child link=\"" + to + "\"/></joint>";
  };
  EXPECT_THAT(error(two(joint("a", "r", "x") + joint("b", "x", "y") + joint("c", "y", "x"))),
              HasSubstr("link 'x' hangs on two joints"));
  EXPECT_THAT(error(two(joint("a", "x", "y") + joint("b", "y", "x"))),
              HasSubstr("hangs on a ring of joints"));
  EXPECT_THAT(error(two(joint("a", "r", "r") + joint("b", "r", "x") + joint("c", "x", "y"))),
              HasSubstr("URDF"));
  EXPECT_THAT(error(two(joint("a", "r", "nobody"))), HasSubstr("nobody"));
  EXPECT_THAT(error(two("")), HasSubstr("is no URDF that can be read"));
}

TEST(BrokenUrdf, NestingAndSizeHaveBounds) {
  std::string deep = "<robot name=\"a\">";
  for (int i = 0; i < 200000; ++i) deep += "<link>";
  EXPECT_THAT(error(deep), HasSubstr("nests its elements deeper"));
}

TEST(BrokenUrdf, NumbersThatAreNone) {
  const std::string good = biped_urdf({});
  for (const char* number : {"nan", "inf", "-inf", "1e999", "", "1 2", "x"}) {
    for (const char* field : {"mass value=\"", "radius=\"", "ixx=\"", "effort=\"", "box size=\"",
                              "xyz=\"", "rpy=\"", "lower=\""}) {
      std::string bad = good;
      auto at = bad.find(field);
      if (at == std::string::npos) continue;
      at += std::string(field).size();
      bad.replace(at, bad.find('"', at) - at, number);
      const std::string said = error(bad);
      // Whichever rule catches it: it is caught, and the file is named.
      EXPECT_THAT(said, HasSubstr("made_up.urdf")) << field << number;
    }
  }
}

TEST(BrokenUrdf, HugeNumbersEndInAnError) {
  const std::string good = biped_urdf({});
  for (const char* field : {"mass value=\"", "ixx=\"", "xyz=\"", "rpy=\"", "lower=\""}) {
    std::string bad = good;
    auto at = bad.find(field) + std::string(field).size();
    const bool three = std::string(field) == "xyz=\"" || std::string(field) == "rpy=\"";
    bad.replace(at, bad.find('"', at) - at, three ? "1e300 1e300 -1e300" : "1e300");
    try {
      find_text(bad);  // some of these are merely odd
    } catch (const std::runtime_error& expected) {
      EXPECT_STRNE(expected.what(), "");
    }
  }
}

TEST(BrokenUrdf, AnyDamageIsAnErrorOrNone) {
  const std::string good = biped_urdf({});
  std::mt19937 random(3);
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random() % static_cast<unsigned>(n));
  };
  int errors = 0;
  for (int i = 0; i < 150; ++i) {
    std::string bad = good;
    switch (i % 4) {
      case 0:
        bad.resize(below(bad.size()));
        break;
      case 1:
        bad.erase(below(bad.size()), 1 + below(200));
        break;
      case 2:
        for (int k = 0; k < 8; ++k) bad[below(bad.size())] = static_cast<char>(random() % 256);
        break;
      default: {  // an element twice, somewhere else
        const auto at = bad.find('<', below(bad.size() - 1000));
        bad.insert(bad.find('<', below(bad.size() - 1000)), bad.substr(at, below(600)));
        break;
      }
    }
    try {
      find_text(bad);
    } catch (const std::runtime_error& expected) {
      ++errors;
      EXPECT_STRNE(expected.what(), "");
    }
  }
  EXPECT_GT(errors, 50);
}

}  // namespace
}  // namespace stagger::sim
