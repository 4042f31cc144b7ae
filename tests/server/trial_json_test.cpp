#include "server/json/trial_json.h"

#include <gmock/gmock.h>

#include "sim/json_file.h"

namespace stagger::server {
namespace {

using ::testing::UnorderedElementsAre;

std::vector<std::string> trial_errors(const std::string& text) {
  sim::JsonErrors errors;
  read_trial(sim::parse_json(text), errors);
  std::vector<std::string> pointers;
  for (const sim::JsonError& error : errors.list()) pointers.push_back(error.pointer);
  return pointers;
}

TEST(TrialJson, OnlyTheRobotIsRequired) {
  sim::JsonErrors errors;
  const sim::TrialSpec spec = read_trial(sim::parse_json(R"({"robot":"kasaei"})"), errors);
  ASSERT_TRUE(errors.empty());
  EXPECT_EQ(spec.robot, "kasaei");
  EXPECT_EQ(spec.plant, sim::PlantKind::bullet);
  EXPECT_EQ(spec.seed, 1U);
  EXPECT_TRUE(spec.strategies.ankle && spec.strategies.step && spec.strategies.time);
  EXPECT_FALSE(spec.senses.perfect_state);
  EXPECT_EQ(spec.senses.control_delay, 0.001);
  EXPECT_FALSE(spec.push);
  EXPECT_THAT(trial_errors("{}"), UnorderedElementsAre("/robot"));
}

TEST(TrialJson, TellsEverythingThatIsWrongAtOnce) {
  EXPECT_THAT(trial_errors(R"({"robot":7,"plant":"mujoco","seed":-1,"walk":{"vx":0.51,"vz":1},
                            "strategies":["ankle","knee"],"settle_s":61,"observe_s":-1,
                            "push":{"impulse_ns":0,"colour":"red"},"terrain":"flat"})"),
              UnorderedElementsAre("/robot", "/plant", "/seed", "/walk/vx", "/walk/vz",
                                   "/strategies", "/settle_s", "/observe_s", "/push/impulse_ns",
                                   "/push/colour", "/terrain"));
}

TEST(TrialJson, TheEndsOfTheRangesHold) {
  EXPECT_TRUE(trial_errors(R"({"robot":"a","walk":{"vx":-0.5,"vy":0.3,"wz":0.5},"settle_s":0,
                            "observe_s":60,"seed":9007199254740992})")
                  .empty());
  EXPECT_THAT(trial_errors(R"({"robot":"a","walk":{"vy":0.31}})"),
              UnorderedElementsAre("/walk/vy"));
  EXPECT_THAT(trial_errors(R"({"robot":"a","walk":{"wz":-0.51}})"),
              UnorderedElementsAre("/walk/wz"));
  EXPECT_THAT(trial_errors(R"({"robot":"a","seed":1.5})"), UnorderedElementsAre("/seed"));
  EXPECT_THAT(trial_errors(R"({"robot":"a","seed":9007199254740994})"),
              UnorderedElementsAre("/seed"));
}

TEST(TrialJson, AnEmptyListOfStrategiesSwitchesAllOff) {
  sim::JsonErrors errors;
  const auto read = [&errors](const char* text) {
    return read_trial(sim::parse_json(text), errors).strategies;
  };
  EXPECT_EQ(read(R"({"robot":"a","strategies":[]})"),
            (engine::Strategies{.ankle = false, .hip = false, .step = false, .time = false}));
  EXPECT_EQ(read(R"({"robot":"a","strategies":["step"]})"),
            (engine::Strategies{.ankle = false, .hip = false, .step = true, .time = false}));
  EXPECT_TRUE(errors.empty());
  EXPECT_THAT(trial_errors(R"({"robot":"a","strategies":["step","step"]})"),
              UnorderedElementsAre("/strategies"));
}

TEST(TrialJson, WhoStandsDoesNotWalk) {
  sim::JsonErrors errors;
  const auto read = [&errors](const char* text) {
    return read_trial(sim::parse_json(text), errors);
  };
  EXPECT_FALSE(read(R"({"robot":"a"})").stand);
  const sim::TrialSpec spec = read(R"({"robot":"a","stand":true,"walk":{"vx":0}})");
  EXPECT_TRUE(spec.stand);
  EXPECT_TRUE(read(trial_spec_json(spec).dump().c_str()).stand);
  EXPECT_TRUE(errors.empty());
  EXPECT_THAT(trial_errors(R"({"robot":"a","stand":true,"walk":{"wz":0.1}})"),
              UnorderedElementsAre("/stand"));
  EXPECT_THAT(trial_errors(R"({"robot":"a","stand":1})"), UnorderedElementsAre("/stand"));
}

TEST(TrialJson, AResolvedTrialReadsBackTheSame) {
  sim::JsonErrors errors;
  const char* text = R"({"robot":"kasaei","plant":"lipm","seed":9,"walk":{"vx":0.1},
      "strategies":["ankle"],"settle_s":1,"observe_s":2,
      "push":{"force_n":80,"direction_deg":33,"trigger":{"phase":"single_support"}}})";
  const Json resolved = trial_spec_json(read_trial(sim::parse_json(text), errors));
  const Json again = trial_spec_json(read_trial(sim::parse_json(resolved.dump()), errors));
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(resolved, again);
  EXPECT_EQ(resolved["seed"], 9);
}

TEST(TrialJson, EveryResultSaysWhatControlKnewAndHowLateItActed) {
  sim::JsonErrors errors;
  const sim::TrialSpec spec = read_trial(
      sim::parse_json(R"({"robot":"a","state":"perfect","control_delay_ms":7})"), errors);
  EXPECT_TRUE(spec.senses.perfect_state);
  EXPECT_NEAR(spec.senses.control_delay, 0.007, 1e-12);
  const Json echo = trial_result_json({}, spec)["spec"];
  EXPECT_EQ(echo["state"], "perfect");
  EXPECT_EQ(echo["control_delay_ms"], 7);
  const Json plain = trial_spec_json(read_trial(sim::parse_json(R"({"robot":"a"})"), errors));
  EXPECT_EQ(plain["state"], "estimated");
  EXPECT_EQ(plain["control_delay_ms"], 1);
  // The pendulum has neither, and does not say that it had.
  const Json lipm =
      trial_spec_json(read_trial(sim::parse_json(R"({"robot":"a","plant":"lipm"})"), errors));
  EXPECT_FALSE(lipm.contains("state"));
  EXPECT_FALSE(lipm.contains("control_delay_ms"));
  EXPECT_TRUE(errors.empty());
  EXPECT_THAT(trial_errors(R"({"robot":"a","state":"exact","control_delay_ms":11})"),
              UnorderedElementsAre("/state", "/control_delay_ms"));
  EXPECT_THAT(trial_errors(R"({"robot":"a","control_delay_ms":1.5})"),
              UnorderedElementsAre("/control_delay_ms"));
}

TEST(TrialJson, TheTerrainIsToldInFull) {
  sim::JsonErrors errors;
  const char* text = R"({"robot":"kasaei","terrain":{"kind":"uneven","height_m":0.02},
                         "self_collision":false})";
  const Json resolved = trial_spec_json(read_trial(sim::parse_json(text), errors));
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(resolved["terrain"]["height_m"], 0.02);
  EXPECT_EQ(resolved["terrain"]["friction"], 0.8);
  EXPECT_EQ(resolved["self_collision"], false);
  EXPECT_EQ(trial_spec_json({})["terrain"]["kind"], "flat");
  EXPECT_EQ(trial_spec_json({})["self_collision"], true);
}

TEST(TrialJson, ThePointMassTakesFlatGroundOnly) {
  const auto on = [](const std::string& terrain) {
    return trial_errors(R"({"robot":"a","plant":"lipm","terrain":)" + terrain + "}");
  };
  EXPECT_THAT(on(R"({"kind":"flat"})"), ::testing::IsEmpty());
  EXPECT_THAT(on(R"({"kind":"slope","angle_deg":3})"), UnorderedElementsAre("/terrain"));
}

TEST(TrialJson, WhatDidNotHappenIsNull) {
  sim::TrialResult result;
  result.outcome = sim::TrialOutcome::timeout;
  result.state_hash = 0xabcULL;
  const Json json = trial_result_json(result, sim::TrialSpec{});
  EXPECT_EQ(json["outcome"], "timeout");
  EXPECT_TRUE(json["push_tick"].is_null());
  EXPECT_TRUE(json["fall_time_s"].is_null());
  EXPECT_TRUE(json["steps_to_recover"].is_null());
  EXPECT_TRUE(json["recovery_time_s"].is_null());
  EXPECT_EQ(json["state_hash"], "0000000000000abc");
}

}  // namespace
}  // namespace stagger::server
