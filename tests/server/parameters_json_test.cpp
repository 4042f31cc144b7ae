#include "server/json/parameters_json.h"

#include <gmock/gmock.h>

#include "sim/json_file.h"

namespace stagger::server {
namespace {

using ::testing::UnorderedElementsAre;

TEST(ParametersJson, NamesAndTypesAreChecked) {
  sim::JsonErrors errors;
  const auto patch = read_parameter_patch(
      sim::parse_json(R"({"gait.t_ss":0.5,"hip.in_steps":true,"gait.t_ds":null,"gait.t_init":"1",
                          "hip.torque":true,"no/such~thing":1,"step.allow_crossing":1})"),
      errors, "/p", true);
  std::vector<std::string> pointers;
  for (const sim::JsonError& error : errors.list()) pointers.push_back(error.pointer);
  EXPECT_THAT(pointers, UnorderedElementsAre("/p/gait.t_init", "/p/hip.torque",
                                             "/p/no~1such~0thing", "/p/step.allow_crossing"));
  EXPECT_EQ(patch.at("gait.t_ss"), 0.5);
  EXPECT_EQ(patch.at("hip.in_steps"), 1.0);
  EXPECT_EQ(patch.at("gait.t_ds"), std::nullopt);
  EXPECT_EQ(
      patched({{"gait.t_ds", 0.1}, {"gait.t_init", 1.0}}, patch),
      (sim::ParameterValues{{"gait.t_ss", 0.5}, {"hip.in_steps", 1.0}, {"gait.t_init", 1.0}}));

  sim::JsonErrors no_object;
  read_parameter_patch(sim::parse_json("[1]"), no_object, "", true);
  EXPECT_EQ(no_object.list().size(), 1U);
  sim::JsonErrors no_null;
  read_parameter_patch(sim::parse_json(R"({"gait.t_ds":null})"), no_null, "", false);
  EXPECT_EQ(no_null.list().size(), 1U);
}

TEST(ParametersJson, TheCommandLineIsChecked) {
  sim::ParameterValues values;
  EXPECT_FALSE(parse_parameter("gait.t_ss=0.5", values));
  EXPECT_FALSE(parse_parameter("hip.in_steps=true", values));
  EXPECT_EQ(values, (sim::ParameterValues{{"gait.t_ss", 0.5}, {"hip.in_steps", 1.0}}));
  for (const char* bad : {"gait.t_ss", "gait.t_ss=", "gait.t_ss=0.5s", "no.such=1", "=1", ""}) {
    EXPECT_TRUE(parse_parameter(bad, values)) << bad;
  }
}

TEST(ParametersJson, WhatIsWrittenIsReadAgain) {
  const sim::ParameterValues values{{"gait.t_ss", 0.1 + 0.2}, {"hip.in_steps", 1.0}};
  const Json json = parameter_values_json(values);
  EXPECT_EQ(json.dump(), R"({"gait.t_ss":0.30000000000000004,"hip.in_steps":true})");
  sim::JsonErrors errors;
  EXPECT_EQ(patched({}, read_parameter_patch(sim::parse_json(json.dump()), errors, "", false)),
            values);
}

TEST(ParametersJson, TheTableTellsWhatWaits) {
  sim::SimulationConfig config;
  config.robot = sim::load_robot("robots/kasaei");
  config.plant = sim::PlantKind::lipm;
  const Json table = parameter_table_json(
      config,
      {{{"gait.t_ss", 0.5}, {"lipm.noise", 0.01}, {"gait.t_ds", 0.1}}, {{"gait.t_ds", 0.1}}});
  std::map<std::string, Json> rows;
  for (const Json& row : table["items"]) rows[row["name"]] = row;
  EXPECT_EQ(rows["gait.t_ss"]["value"], 0.5);
  EXPECT_EQ(rows["gait.t_ss"]["active"], 0.36);
  EXPECT_EQ(rows["gait.t_ss"]["default"], 0.36);
  EXPECT_EQ(rows["gait.t_ss"]["waits_for"], "next_step");
  EXPECT_EQ(rows["gait.t_ss"]["unit"], "s");
  EXPECT_EQ(rows["lipm.noise"]["waits_for"], "reset");
  EXPECT_EQ(rows["gait.t_ds"]["waits_for"], nullptr);
  EXPECT_EQ(rows["hip.in_steps"]["type"], "boolean");
  EXPECT_FALSE(rows.contains("body.com_weight"));
}

}  // namespace
}  // namespace stagger::server
