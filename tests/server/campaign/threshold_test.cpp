#include "server/campaign/threshold.h"

#include <gtest/gtest.h>

namespace stagger::server::campaign {
namespace {

TEST(Threshold, IsReadWithItsConditions) {
  const Threshold t = parse_threshold(
      "max(steps_to_recover) <= 4.5 where push.impulse_ns <= 8 and robot == kasaei and stand == "
      "false");
  EXPECT_EQ(t.aggregate.function, "max");
  EXPECT_EQ(t.aggregate.measure, "steps_to_recover");
  EXPECT_EQ(t.comparison, Comparison::at_most);
  EXPECT_EQ(t.value, 4.5);
  ASSERT_EQ(t.conditions.size(), 3U);
  EXPECT_EQ(t.conditions[0].path, "push.impulse_ns");
  EXPECT_EQ(t.conditions[0].value, 8);
  EXPECT_EQ(t.conditions[1].value, "kasaei");
  EXPECT_EQ(t.conditions[2].value, false);
}

TEST(Threshold, RefusesTellingWhereAndWhatIsAllowed) {
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {"", "fall_rate"},
           {"rate == 0", "fall_rate"},
           {"fall_rate = 0", "=="},
           {"fall_rate == none", "a number"},
           {"fall_rate == nan", "a number"},
           {"fall_rate == 0x", "a number"},
           {"sum(fr) == 0", "mean"},
           {"min(knee) > 1", "limit_ns"},
           {"min(fr > 1", "')'"},
           {"fall_rate == 0 when a == 1", "where"},
           {"fall_rate == 0 where", "a field"},
           {"falls < 1 where a < torso", "no number"},
           {"falls < 1 where a == \"x", "quotation"},
           {"falls < 1 where a == 1 or b == 2", "and"}}) {
    try {
      parse_threshold(text);
      ADD_FAILURE() << text;
    } catch (const ThresholdError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
}

TEST(Threshold, ConditionsCompareNumbersAndTexts) {
  const Condition at_most{"a", Comparison::at_most, 8};
  EXPECT_TRUE(holds(at_most, 8.0));
  EXPECT_FALSE(holds(at_most, 8.1));
  EXPECT_FALSE(holds(at_most, nullptr));
  EXPECT_FALSE(holds(at_most, "8"));
  EXPECT_TRUE(holds({"a", Comparison::equal, "torso"}, "torso"));
  EXPECT_TRUE(holds({"a", Comparison::unequal, "torso"}, "pelvis"));
  EXPECT_FALSE(holds({"a", Comparison::unequal, "torso"}, nullptr));
}

TEST(Threshold, StatisticsOfValues) {
  EXPECT_FALSE(statistic("min", {}));
  const std::vector<double> values{5, 1, 4, 2, 3};
  EXPECT_EQ(*statistic("min", values), 1);
  EXPECT_EQ(*statistic("max", values), 5);
  EXPECT_EQ(*statistic("mean", values), 3);
  EXPECT_EQ(*statistic("median", values), 3);
  EXPECT_EQ(*statistic("p95", values), 5);
}

}  // namespace
}  // namespace stagger::server::campaign
