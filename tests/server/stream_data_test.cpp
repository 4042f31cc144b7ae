#include "server/json/stream_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

namespace stagger::server {
namespace {

SessionPtr session() {
  auto info = std::make_shared<SessionInfo>();
  info->channels = sim::make_channels({"left_knee"});
  return info;
}

FrameMessage frame() {
  FrameMessage message;
  message.session = session();
  message.frame.tick = 5230;
  message.frame.time = 5.23;
  message.frame.com = sim::Vec3(0.1, 1.0 / 3.0, 1e-17);
  message.frame.dcm = sim::Vec2(0.1, 1.0 / 3.0);
  message.frame.joint_count = 1;
  message.frame.joint_position[0] = -1e-17;
  message.frame.support_polygon_count = 3;
  message.frame.support_polygon = {sim::Vec2(1.0, 2.0), sim::Vec2(3.0, 4.0), sim::Vec2(7.0, 8.0)};
  return message;
}

SubscriptionPtr wants(std::vector<ChannelChoice> channels,
                      StreamFormat format = StreamFormat::json) {
  Subscription subscription;
  subscription.channels = std::move(channels);
  subscription.format = format;
  subscription.rates = {100.0, 10.0};
  return std::make_shared<const Subscription>(std::move(subscription));
}

nlohmann::json text(const FrameMessage& message, const SubscriptionPtr& subscription,
                    RateMask due = 3) {
  DataWriter writer;
  return nlohmann::json::parse(writer.write(message, subscription, 17, due));
}

template <typename T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  EXPECT_LE(offset + sizeof value, bytes.size());
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST(StreamData, HoldsTheAskedChannelsToTheBit) {
  const auto data = text(frame(), wants({{"dcm", 0, {}}, {"joint_position", 0, {}}}));
  EXPECT_EQ(data["op"], "data");
  EXPECT_EQ(data["seq"], 17);
  EXPECT_EQ(data["tick"], 5230);
  EXPECT_EQ(data["t"], 5.23);
  EXPECT_EQ(data["v"].size(), 2U);
  EXPECT_EQ(data["v"]["dcm"][1].get<double>(), 1.0 / 3.0);
  EXPECT_EQ(data["v"]["joint_position"][0].get<double>(), -1e-17);
}

TEST(StreamData, OfAllChannelsIsAsLongAsHelloSays) {
  const FrameMessage message = frame();
  const auto data = text(message, std::make_shared<const Subscription>());
  for (const sim::Channel& channel : message.session->channels) {
    ASSERT_TRUE(data["v"].contains(channel.name)) << channel.name;
    const std::size_t size = data["v"][channel.name].size();
    EXPECT_EQ(size % channel.components.size(), 0U) << channel.name;
    EXPECT_LE(size, channel.components.size() * channel.max_repeat) << channel.name;
    if (channel.max_repeat == 1) {
      EXPECT_EQ(size, channel.components.size()) << channel.name;
    }
  }
}

TEST(StreamData, WhatIsNotFiniteIsNull) {
  FrameMessage message = frame();
  message.frame.dcm =
      sim::Vec2(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity());
  const auto data = text(message, wants({{"dcm", 0, {}}}));
  EXPECT_TRUE(data["v"]["dcm"][0].is_null());
  EXPECT_TRUE(data["v"]["dcm"][1].is_null());
}

TEST(StreamData, ChannelsComeAtTheirRatesWithTheirFields) {
  const auto wanted =
      wants({{"com", 1, {"z", "x"}}, {"dcm", 0, {}}, {"support_polygon", 0, {"y"}}});
  EXPECT_EQ(text(frame(), wanted, 1)["v"].size(), 2U);
  EXPECT_EQ(text(frame(), wanted, 2)["v"], nlohmann::json({{"com", {0.1, 1e-17}}}));
  EXPECT_EQ(text(frame(), wanted, 3)["v"]["support_polygon"], nlohmann::json({2.0, 4.0, 8.0}));
}

TEST(StreamData, WhatAnotherSessionDoesNotHaveIsLeftOut) {
  FrameMessage message = frame();
  auto other = std::make_shared<SessionInfo>();
  other->channels = sim::make_channels({"right_knee"});
  message.session = other;
  const auto data = text(message, wants({{"dcm", 0, {}}, {"joint_position", 0, {"left_knee"}}}));
  EXPECT_EQ(data["v"]["joint_position"], nlohmann::json::array());
  EXPECT_EQ(data["v"]["dcm"].size(), 2U);
}

TEST(StreamData, BinaryIsAsTheDocumentationSays) {
  DataWriter writer;
  const auto wanted =
      wants({{"dcm", 0, {}}, {"support_polygon", 0, {}}, {"com", 1, {}}}, StreamFormat::float64);
  const std::string bytes = writer.write(frame(), wanted, 17, 1);
  EXPECT_EQ(bytes[0], 1);
  EXPECT_EQ(bytes[1], 8);
  EXPECT_EQ(at<std::uint16_t>(bytes, 2), 1);
  EXPECT_EQ(at<std::uint32_t>(bytes, 4), 8U);
  EXPECT_EQ(at<std::uint64_t>(bytes, 8), 17U);
  EXPECT_EQ(at<std::uint64_t>(bytes, 16), 5230U);
  EXPECT_EQ(at<double>(bytes, 24), 5.23);
  EXPECT_EQ(bytes[32], 3) << "corners";
  ASSERT_EQ(bytes.size(), 40U + 8U * 8U);
  EXPECT_EQ(at<double>(bytes, 40), 0.1);
  EXPECT_EQ(at<double>(bytes, 48), 1.0 / 3.0);
  EXPECT_EQ(at<double>(bytes, 56 + 5 * 8), 8.0);
}

TEST(StreamData, BinaryHoldsWhatTextHolds) {
  const FrameMessage message = frame();
  Subscription all;
  const auto json = text(message, std::make_shared<const Subscription>(all), 1);
  for (const StreamFormat format : {StreamFormat::float64, StreamFormat::float32}) {
    all.format = format;
    DataWriter writer;
    const std::string bytes =
        writer.write(message, std::make_shared<const Subscription>(all), 17, 1);
    const std::size_t width = format == StreamFormat::float64 ? 8 : 4;
    std::size_t lists = 0;
    for (const auto& channel : message.session->channels) lists += channel.max_repeat > 1 ? 1 : 0;
    std::size_t offset = (32 + lists + 7) / 8 * 8;
    for (const auto& channel : message.session->channels) {
      for (const auto& value : json["v"][channel.name]) {
        if (width == 8) {
          EXPECT_EQ(at<double>(bytes, offset), value.get<double>()) << channel.name;
        } else {
          EXPECT_EQ(at<float>(bytes, offset), static_cast<float>(value.get<double>()))
              << channel.name;
        }
        offset += width;
      }
    }
    EXPECT_EQ(offset, bytes.size());
  }
}

TEST(StreamData, BinaryKeepsItsLengthWhateverTheFrameHolds) {
  FrameMessage message = frame();
  message.frame.joint_count = 0;
  DataWriter writer;
  const std::string bytes =
      writer.write(message, wants({{"joint_position", 0, {}}}, StreamFormat::float32), 0, 1);
  ASSERT_EQ(bytes.size(), 36U);
  EXPECT_TRUE(std::isnan(at<float>(bytes, 32)));
}

}  // namespace
}  // namespace stagger::server
