#include "server/json/stream_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace stagger::server {
namespace {

std::shared_ptr<SessionInfo> kasaei_session() {
  auto info = std::make_shared<SessionInfo>();
  info->id = "0011";
  info->robot = "kasaei";
  info->channels = sim::make_channels({"left_knee"});
  return info;
}

std::vector<std::string> subscription_errors(const std::string& text) {
  sim::JsonErrors errors;
  read_subscription(text, *kasaei_session(), errors);
  std::vector<std::string> pointers;
  for (const sim::JsonError& error : errors.list()) pointers.push_back(error.pointer);
  return pointers;
}

TEST(StreamJson, HelloDescribesEveryChannel) {
  const auto info = kasaei_session();
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
  const Subscription s =
      read_subscription(R"({"op":"subscribe","rate_hz":30,"channels":["com"],"events":false})",
                        *kasaei_session(), errors);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(s.rates, std::vector<double>{30.0});
  ASSERT_TRUE(s.channels);
  ASSERT_EQ(s.channels->size(), 1U);
  EXPECT_EQ(s.channels->front().name, "com");
  EXPECT_FALSE(s.events);
  EXPECT_EQ(s.format, StreamFormat::json);
  EXPECT_TRUE(subscription_errors(R"({"op":"subscribe"})").empty());
}

TEST(StreamJson, ReadsChannelsWithRatesAndFieldsOfTheirOwn) {
  sim::JsonErrors errors;
  const Subscription s = read_subscription(
      R"({"op":"subscribe","rate_hz":50,"format":"float32","channels":[
          {"name":"com","rate_hz":200,"fields":["z","x"]},{"name":"dcm"},{"name":"zmp"}]})",
      *kasaei_session(), errors);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(s.rates, (std::vector<double>{200.0, 50.0}));
  EXPECT_EQ(s.format, StreamFormat::float32);
  ASSERT_EQ(s.channels->size(), 3U);
  EXPECT_EQ(s.channels->at(0).rate, 0U);
  EXPECT_EQ(s.channels->at(0).fields, (std::vector<std::string>{"z", "x"}));
  EXPECT_EQ(s.channels->at(2).rate, 1U);

  const auto answer = nlohmann::json::parse(subscribed_text(s, *kasaei_session()));
  EXPECT_EQ(answer["format"], "float32");
  EXPECT_EQ(answer["rates_hz"], nlohmann::json({200.0, 50.0}));
  EXPECT_EQ(answer["channels"], nlohmann::json({"com", "dcm", "zmp"}));
  EXPECT_EQ(answer["layout"][0]["rate"], 0);
  EXPECT_EQ(answer["layout"][0]["fields"], nlohmann::json({"x", "z"})) << "in hello's order";
}

TEST(StreamJson, RefusesWhatIsNotUnderstood) {
  using List = std::vector<std::string>;
  EXPECT_EQ(subscription_errors("hello"), List{""});
  EXPECT_EQ(subscription_errors("[]"), List{""});
  EXPECT_EQ(subscription_errors(R"({"op":"unsubscribe"})"), List{"/op"});
  EXPECT_EQ(subscription_errors(R"({"rate_hz":10})"), List{"/op"});
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","rate_hz":1001})"), List{"/rate_hz"});
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","rate_hz":0.5})"), List{"/rate_hz"});
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","channels":["com","nope"]})"),
            List{"/channels"});
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","rate":10})"), List{"/rate"});
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","format":"text"})"), List{"/format"});
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","channels":["com","com"]})"),
            List{"/channels"});
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","channels":"com"})"), List{"/channels"});
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","channels":[{"rate_hz":1}]})").front(),
            "/channels/0/name");
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","channels":[{"name":"com","rate_hz":0}]})"),
            List{"/channels/0/rate_hz"});
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","channels":[{"name":"com","fields":["w"]}]})"),
            List{"/channels/0/fields"});
  EXPECT_EQ(
      subscription_errors(R"({"op":"subscribe","channels":[{"name":"com","fields":["x","x"]}]})"),
      List{"/channels/0/fields"});
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","channels":[{"name":"com","unit":"m"}]})"),
            List{"/channels/0/unit"});
}

TEST(StreamJson, RefusesMoreRatesThanAMessageCanName) {
  std::string channels;
  for (std::size_t i = 0; i <= Subscription::max_rates; ++i) {
    channels += (i > 0 ? "," : "") + (R"({"name":")" + kasaei_session()->channels.at(i).name +
                                      R"(","rate_hz":)" + std::to_string(i + 1) + "}");
  }
  EXPECT_EQ(subscription_errors(R"({"op":"subscribe","channels":[)" + channels + "]}"),
            std::vector<std::string>{"/channels"});
}

}  // namespace
}  // namespace stagger::server
