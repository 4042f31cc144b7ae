#include "server/json/stream_json.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace stagger::server {
namespace {

std::shared_ptr<SessionInfo> session() {
  auto info = std::make_shared<SessionInfo>();
  info->id = "0011";
  info->robot = "kasaei";
  info->channels = sim::make_channels({"left_knee"});
  return info;
}

std::vector<std::string> errors_of(const std::string& text) {
  sim::JsonErrors errors;
  read_subscription(text, *session(), errors);
  std::vector<std::string> pointers;
  for (const sim::JsonError& error : errors.list()) pointers.push_back(error.pointer);
  return pointers;
}

TEST(StreamJson, HelloDescribesEveryChannel) {
  const auto info = session();
  const auto hello = nlohmann::json::parse(hello_text(*info));
  EXPECT_EQ(hello["op"], "hello");
  EXPECT_EQ(hello["protocol"], 1);
  EXPECT_EQ(hello["session_id"], "0011");
  EXPECT_EQ(hello["tick_s"], 0.001);
  EXPECT_EQ(hello["terrain"]["kind"], "flat");
  ASSERT_EQ(hello["channels"].size(), info->channels.size());
  EXPECT_EQ(hello["states"].size(), 4U);
  for (const auto& channel : hello["channels"]) {
    EXPECT_FALSE(channel["name"].get<std::string>().empty());
    EXPECT_FALSE(channel["meaning"].get<std::string>().empty());
    EXPECT_GE(channel["components"].size(), 1U);
  }
}

TEST(StreamJson, DataHoldsTheAskedChannelsToTheBit) {
  FrameMessage message;
  message.session = session();
  message.frame.tick = 5230;
  message.frame.time = 5.23;
  message.frame.dcm = sim::Vec2(0.1, 1.0 / 3.0);
  Subscription wanted;
  wanted.channels = {"dcm", "joint_position"};
  message.frame.joint_count = 1;
  message.frame.joint_position[0] = -1e-17;
  DataWriter writer;
  const auto data =
      nlohmann::json::parse(writer.text(message, std::make_shared<const Subscription>(wanted), 17));
  EXPECT_EQ(data["op"], "data");
  EXPECT_EQ(data["seq"], 17);
  EXPECT_EQ(data["tick"], 5230);
  EXPECT_EQ(data["t"], 5.23);
  EXPECT_EQ(data["v"].size(), 2U);
  EXPECT_EQ(data["v"]["dcm"][1].get<double>(), 1.0 / 3.0);
  EXPECT_EQ(data["v"]["joint_position"][0].get<double>(), -1e-17);
}

TEST(StreamJson, DataOfAllChannelsIsAsLongAsHelloSays) {
  FrameMessage message;
  message.session = session();
  message.frame.joint_count = 1;
  DataWriter writer;
  const auto data =
      nlohmann::json::parse(writer.text(message, std::make_shared<const Subscription>(), 0));
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

TEST(StreamJson, WhatIsNotFiniteIsNull) {
  FrameMessage message;
  message.session = session();
  message.frame.dcm =
      sim::Vec2(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity());
  Subscription wanted;
  wanted.channels = {"dcm"};
  DataWriter writer;
  const auto data =
      nlohmann::json::parse(writer.text(message, std::make_shared<const Subscription>(wanted), 0));
  EXPECT_TRUE(data["v"]["dcm"][0].is_null());
  EXPECT_TRUE(data["v"]["dcm"][1].is_null());
}

TEST(StreamJson, AnEventTellsItsSource) {
  EventMessage event;
  event.kind = "command";
  event.text = "walk";
  event.values = {{"vx", 0.1}};
  event.source = "http";
  const auto json = nlohmann::json::parse(event_text(event));
  EXPECT_EQ(json["kind"], "command");
  EXPECT_EQ(json["values"]["vx"], 0.1);
  EXPECT_EQ(json["source"], "http");
  event.source.clear();
  EXPECT_FALSE(nlohmann::json::parse(event_text(event)).contains("source"));
}

TEST(StreamJson, ReadsSubscriptions) {
  sim::JsonErrors errors;
  const Subscription s = read_subscription(
      R"({"op":"subscribe","rate_hz":30,"channels":["com"],"events":false})", *session(), errors);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(s.rate_hz, 30.0);
  EXPECT_EQ(s.channels, std::vector<std::string>{"com"});
  EXPECT_FALSE(s.events);
  EXPECT_TRUE(errors_of(R"({"op":"subscribe"})").empty());
}

TEST(StreamJson, RefusesWhatIsNotUnderstood) {
  using List = std::vector<std::string>;
  EXPECT_EQ(errors_of("hello"), List{""});
  EXPECT_EQ(errors_of("[]"), List{""});
  EXPECT_EQ(errors_of(R"({"op":"unsubscribe"})"), List{"/op"});
  EXPECT_EQ(errors_of(R"({"rate_hz":10})"), List{"/op"});
  EXPECT_EQ(errors_of(R"({"op":"subscribe","rate_hz":1001})"), List{"/rate_hz"});
  EXPECT_EQ(errors_of(R"({"op":"subscribe","rate_hz":0.5})"), List{"/rate_hz"});
  EXPECT_EQ(errors_of(R"({"op":"subscribe","channels":["com","nope"]})"), List{"/channels"});
  EXPECT_EQ(errors_of(R"({"op":"subscribe","rate":10})"), List{"/rate"});
}

}  // namespace
}  // namespace stagger::server
