#include "sim/channels.h"

#include <gtest/gtest.h>

#include <set>

namespace stagger::sim {
namespace {

TEST(Channels, EveryChannelIsDescribedAndNamedOnce) {
  const auto table = make_channels({"left_knee", "right_knee"});
  std::set<std::string> names;
  for (const Channel& channel : table) {
    EXPECT_TRUE(names.insert(channel.name).second) << channel.name;
    EXPECT_FALSE(channel.meaning.empty()) << channel.name;
    EXPECT_FALSE(channel.components.empty()) << channel.name;
    for (const Component& component : channel.components) {
      EXPECT_FALSE(component.name.empty()) << channel.name;
      EXPECT_FALSE(component.unit.empty()) << channel.name;
    }
  }
}

TEST(Channels, EachReadsAsManyNumbersAsItDeclares) {
  Frame frame;
  frame.joint_count = 2;
  frame.preview_count = 3;
  frame.support_polygon_count = 6;
  frame.capture_region.count = 12;
  frame.swing_path_count = 5;
  frame.ground_force_count = 8;
  for (const Channel& channel : make_channels({"left_knee", "right_knee"})) {
    std::vector<double> values;
    channel.read(frame, values);
    ASSERT_EQ(values.size() % channel.components.size(), 0U) << channel.name;
    EXPECT_LE(values.size(), channel.max_repeat * channel.components.size()) << channel.name;
    if (channel.max_repeat == 1) {
      EXPECT_EQ(values.size(), channel.components.size()) << channel.name;
    }
  }
}

TEST(Channels, ReadTheFieldTheyAreNamedAfter) {
  Frame frame;
  frame.dcm = {1.0, 2.0};
  frame.feet[1].position = {3.0, 4.0, 5.0};
  frame.feet[1].yaw = 6.0;
  frame.state = WalkingState::double_support;
  const auto table = make_channels({});
  const auto read = [&](const char* name) {
    std::vector<double> values;
    find_channel(table, name)->read(frame, values);
    return values;
  };
  EXPECT_EQ(read("dcm"), (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(read("right_foot"), (std::vector<double>{3.0, 4.0, 5.0, 6.0}));
  EXPECT_EQ(read("state"), std::vector<double>{3.0});
  EXPECT_EQ(find_channel(table, "nonsense"), nullptr);
}

}  // namespace
}  // namespace stagger::sim
