#include "sim/plant/body_pairs.h"

#include <gtest/gtest.h>

#include "sim/robot/robot.h"

namespace stagger::sim {
namespace {

class BodyPairsTest : public ::testing::Test {
 protected:
  int body(const char* link) const { return robot_->model.links.at(link).body; }
  bool may_touch(const char* first, const char* second) const {
    return pairs_.may_touch(body(first), body(second));
  }

  std::shared_ptr<const Robot> robot_ = load_robot("robots/kasaei");
  BodyPairs pairs_{robot_->model};
};

TEST_F(BodyPairsTest, EveryPartOfALegMayTouchEveryPartOfTheOther) {
  for (const char* left : {"left_thigh", "left_shank", "left_foot"}) {
    for (const char* right : {"right_thigh", "right_shank", "right_foot"}) {
      EXPECT_TRUE(may_touch(left, right)) << left << " " << right;
      EXPECT_TRUE(may_touch(right, left)) << left << " " << right;
    }
  }
}

TEST_F(BodyPairsTest, NeighboursNeverTouch) {
  EXPECT_FALSE(may_touch("left_thigh", "left_shank"));
  // Only hip and ankle links without shapes lie between these.
  EXPECT_FALSE(may_touch("pelvis", "left_thigh"));
  EXPECT_FALSE(may_touch("left_shank", "left_foot"));
  EXPECT_TRUE(may_touch("pelvis", "left_shank"));
  EXPECT_TRUE(may_touch("left_thigh", "left_foot"));
}

TEST_F(BodyPairsTest, BodiesWithoutShapesTouchNothing) {
  for (const auto& [first, second] : pairs_.list()) {
    EXPECT_FALSE(robot_->model.bodies[first].shapes.empty());
    EXPECT_FALSE(robot_->model.bodies[second].shapes.empty());
  }
}

TEST_F(BodyPairsTest, ListsEachPairOnceUntilItIsForbidden) {
  // Of 7 bodies with shapes: 21 pairs, less the 6 neighbours.
  EXPECT_EQ(pairs_.list().size(), 15u);
  pairs_.forbid(body("right_foot"), body("left_foot"));
  EXPECT_EQ(pairs_.list().size(), 14u);
  EXPECT_FALSE(may_touch("left_foot", "right_foot"));
  EXPECT_FALSE(may_touch("right_foot", "left_foot"));
}

}  // namespace
}  // namespace stagger::sim
