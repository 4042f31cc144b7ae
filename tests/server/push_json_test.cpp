#include "server/json/push_json.h"

#include <gmock/gmock.h>

#include <numbers>

#include "sim/json_file.h"

namespace stagger::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Read {
  sim::PushSpec push;
  std::vector<sim::JsonError> errors;
};

Read read_push_text(const std::string& text) {
  sim::JsonErrors errors;
  Read result;
  sim::read_json(sim::parse_json(text), errors,
                 [&result](sim::JsonReader& reader) { result.push = read_push(reader); });
  result.errors = errors.list();
  return result;
}

std::vector<std::string> pointers(const Read& read) {
  std::vector<std::string> list;
  for (const sim::JsonError& error : read.errors) list.push_back(error.pointer);
  return list;
}

TEST(PushJson, FillsInTheDefaults) {
  const Read r = read_push_text(R"({"impulse_ns":12.5})");
  ASSERT_TRUE(r.errors.empty());
  EXPECT_EQ(r.push.link, "");  // the robot's torso
  EXPECT_FALSE(r.push.point);
  EXPECT_EQ(r.push.direction, sim::Vec3::UnitX());
  EXPECT_EQ(r.push.impulse_ns, 12.5);
  EXPECT_EQ(r.push.duration_s, 0.1);
  EXPECT_EQ(r.push.profile, sim::PushProfile::rectangular);
  EXPECT_TRUE(std::holds_alternative<sim::Immediate>(r.push.trigger));
}

TEST(PushJson, TurnsAnglesIntoDirectionsInTheHeadingsFrame) {
  EXPECT_EQ(read_push_text(R"({"impulse_ns":1,"direction_deg":90})").push.direction,
            sim::Vec3::UnitY());
  EXPECT_EQ(read_push_text(R"({"impulse_ns":1,"direction_deg":-90})").push.direction,
            -sim::Vec3::UnitY());
  EXPECT_EQ(read_push_text(R"({"impulse_ns":1,"direction_deg":180})").push.direction,
            -sim::Vec3::UnitX());
  const sim::Vec3 slanted = read_push_text(R"({"impulse_ns":1,"direction_deg":30})").push.direction;
  EXPECT_NEAR(slanted.x(), std::sqrt(3.0) / 2.0, 1e-12);
  EXPECT_NEAR(slanted.y(), 0.5, 1e-12);
}

TEST(PushJson, NormalisesVectors) {
  const Read r = read_push_text(R"({"impulse_ns":1,"direction":[0,3,4]})");
  ASSERT_TRUE(r.errors.empty());
  EXPECT_NEAR((r.push.direction - sim::Vec3(0.0, 0.6, 0.8)).norm(), 0.0, 1e-15);
}

TEST(PushJson, AForceIsItsPeak) {
  EXPECT_DOUBLE_EQ(read_push_text(R"({"force_n":50,"duration_s":0.2})").push.impulse_ns, 10.0);
  const Read sine = read_push_text(R"({"force_n":50,"duration_s":0.2,"profile":"half_sine"})");
  EXPECT_DOUBLE_EQ(sine.push.impulse_ns, 20.0 / std::numbers::pi);
}

TEST(PushJson, RefusesWhatIsOutOfRangeByName) {
  const Read r =
      read_push_text(R"({"impulse_ns":-3,"duration_s":3,"direction_deg":500,"profile":"step",
                          "point":[0,0],"at_s":-1,"link":""})");
  EXPECT_THAT(pointers(r),
              ::testing::UnorderedElementsAre("/impulse_ns", "/duration_s", "/direction_deg",
                                              "/profile", "/point", "/at_s", "/link"));
  const Read impulse = read_push_text(R"({"impulse_ns":-3})");
  ASSERT_EQ(impulse.errors.size(), 1U);
  EXPECT_EQ(impulse.errors[0].text, "is -3; allowed: more than 0 to 200 N s");
}

TEST(PushJson, TheEndsOfTheRangesHold) {
  EXPECT_TRUE(read_push_text(R"({"impulse_ns":200,"duration_s":2})").errors.empty());
  EXPECT_THAT(pointers(read_push_text(R"({"impulse_ns":200.001})")), ElementsAre("/impulse_ns"));
  EXPECT_THAT(pointers(read_push_text(R"({"impulse_ns":0})")), ElementsAre("/impulse_ns"));
  EXPECT_TRUE(read_push_text(R"({"impulse_ns":1,"duration_s":0.001})").errors.empty());
  EXPECT_THAT(pointers(read_push_text(R"({"impulse_ns":1,"duration_s":0.0009})")),
              ElementsAre("/duration_s"));
}

TEST(PushJson, AForceMustStayWithinTheImpulseLimit) {
  EXPECT_TRUE(read_push_text(R"({"force_n":20000,"duration_s":0.01})").errors.empty());
  EXPECT_THAT(pointers(read_push_text(R"({"force_n":20000,"duration_s":0.011})")),
              ElementsAre("/force_n"));
}

TEST(PushJson, RefusesContradictions) {
  EXPECT_THAT(pointers(read_push_text(R"({"impulse_ns":1,"force_n":1})")), ElementsAre("/force_n"));
  EXPECT_THAT(pointers(read_push_text("{}")), ElementsAre("/impulse_ns"));
  EXPECT_THAT(pointers(read_push_text(R"({"impulse_ns":1,"direction":[1,0,0],"direction_deg":0})")),
              ElementsAre("/direction"));
  EXPECT_THAT(
      pointers(read_push_text(R"({"impulse_ns":1,"at_s":1,"trigger":{"phase":"single_support"}})")),
      ElementsAre("/at_s"));
  EXPECT_THAT(pointers(read_push_text(R"({"impulse_ns":1,"direction":[0,0,0]})")),
              ElementsAre("/direction"));
}

TEST(PushJson, RefusesUnknownFieldsAndNamesTheKnownOnes) {
  const Read r =
      read_push_text(R"({"impulse_ns":1,"impuls":2,"trigger":{"phase":"single_support","x":1}})");
  EXPECT_THAT(pointers(r), ElementsAre("/trigger/x", "/impuls"));
  EXPECT_THAT(r.errors[1].text, HasSubstr("impulse_ns"));
}

TEST(PushJson, ReadsTriggers) {
  const Read r = read_push_text(R"({"impulse_ns":1,
      "trigger":{"phase":"double_support","leg":"right","fraction":0.25}})");
  ASSERT_TRUE(r.errors.empty());
  const auto& trigger = std::get<sim::PhaseTrigger>(r.push.trigger);
  EXPECT_EQ(trigger.phase, engine::WalkingState::double_support);
  EXPECT_EQ(trigger.leg, sim::Side::right);
  EXPECT_EQ(trigger.fraction, 0.25);
  EXPECT_THAT(
      pointers(read_push_text(R"({"impulse_ns":1,"trigger":{"phase":"idle","fraction":1}})")),
      ElementsAre("/trigger/phase", "/trigger/fraction"));
  EXPECT_EQ(
      std::get<sim::TimeTrigger>(read_push_text(R"({"impulse_ns":1,"at_s":2.5})").push.trigger)
          .at_s,
      2.5);
}

// A push that is copied from an answer must be the same push to the bit.
TEST(PushJson, AResolvedPushReadsBackToTheBit) {
  for (const char* text :
       {R"({"impulse_ns":0.1,"direction_deg":37})", R"({"force_n":333.3,"direction":[1,2,3]})",
        R"({"impulse_ns":7,"direction":[-0.3,0.1,0.77],"point":[0.1,-0.2,0.3],"at_s":1.7})",
        R"({"force_n":11,"profile":"half_sine","duration_s":0.37,
            "trigger":{"phase":"single_support","fraction":0.3}})"}) {
    const Read first = read_push_text(text);
    ASSERT_TRUE(first.errors.empty()) << text;
    const Json resolved = push_spec_json(first.push);
    const Read second = read_push_text(resolved.dump());
    ASSERT_TRUE(second.errors.empty()) << resolved.dump();
    EXPECT_EQ(first.push.direction, second.push.direction) << text;
    EXPECT_EQ(first.push.impulse_ns, second.push.impulse_ns) << text;
    EXPECT_EQ(push_spec_json(second.push), resolved) << text;
  }
}

TEST(PushJson, ARecordTellsWhatBecameOfThePush) {
  sim::PushRecord record;
  record.id = 7;
  record.created_tick = 1500;
  record.spec.impulse_ns = 4.0;
  record.state = sim::PushState::done;
  record.start_tick = 1510;
  record.end_tick = 1609;
  record.delivered = sim::Vec3(4.0, 0.0, 0.0);
  const Json json = push_record_json(record, 0.001);
  EXPECT_EQ(json["id"], 7);
  EXPECT_EQ(json["state"], "done");
  EXPECT_EQ(json["tick"], 1500);
  EXPECT_EQ(json["time_s"], 1.5);
  EXPECT_EQ(json["start_tick"], 1510);
  EXPECT_EQ(json["end_tick"], 1609);
  EXPECT_EQ(json["delivered_ns"], Json::array({4.0, 0.0, 0.0}));
  record.start_tick.reset();
  EXPECT_TRUE(push_record_json(record, 0.001)["start_tick"].is_null());
}

}  // namespace
}  // namespace stagger::server
