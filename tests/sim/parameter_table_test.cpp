#include "sim/parameter_table.h"

#include <gtest/gtest.h>

#include <set>

#include "sim/experiment/trial.h"
#include "sim/simulation.h"

namespace stagger::sim {
namespace {

SimulationConfig config_of(const std::string& robot, PlantKind plant) {
  SimulationConfig config;
  config.robot = load_robot("robots/" + robot);
  config.plant = plant;
  return config;
}

TEST(ParameterTable, NamesAreUniqueAndEveryRowTellsWhatItIs) {
  std::set<std::string_view> names;
  for (const ParameterInfo& info : parameter_table()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_FALSE(info.meaning.empty()) << info.name;
    EXPECT_LT(info.least, info.most) << info.name;
    EXPECT_TRUE(info.bullet || info.lipm) << info.name;
    EXPECT_EQ(find_parameter(info.name), &info);
  }
  EXPECT_EQ(find_parameter("gait.t_sss"), nullptr);
}

TEST(ParameterTable, EveryRobotsOwnValuesAreAllowedAndEachNameSetsOneThing) {
  for (const char* robot : {"kasaei", "op3", "g1", "h1_2"}) {
    for (const PlantKind plant : {PlantKind::bullet, PlantKind::lipm}) {
      const SimulationConfig config = config_of(robot, plant);
      const WorldParameters own = default_parameters(config);
      for (const ParameterInfo& info : parameter_table()) {
        const ParameterRange range = allowed(info, info.get(own));
        EXPECT_GE(info.get(own), range.least) << robot << ' ' << info.name;
        EXPECT_LE(info.get(own), range.most) << robot << ' ' << info.name;
        WorldParameters changed = own;
        const double other = info.get(own) == range.most ? range.least : range.most;
        info.set(changed, other);
        EXPECT_EQ(info.get(changed), other) << info.name;
        for (const ParameterInfo& rest : parameter_table()) {
          if (&rest == &info) continue;
          EXPECT_EQ(rest.get(changed), rest.get(own)) << info.name;
        }
      }
    }
  }
}

TEST(ParameterTable, WhatCannotBeIsToldByNameAndRange) {
  const SimulationConfig config = config_of("kasaei", PlantKind::lipm);
  EXPECT_TRUE(check_parameters(config, {}).empty());
  EXPECT_TRUE(check_parameters(config, {{"gait.t_ss", 0.5}, {"lipm.noise", 0.001}}).empty());
  const auto faults = check_parameters(config, {{"gait.t_ss", 9.0},
                                                {"gait.unknown", 1.0},
                                                {"hip.in_steps", 0.5},
                                                {"body.com_weight", 900.0},
                                                {"gait.t_ds", std::nan("")}});
  std::set<std::string> names;
  for (const ParameterFault& fault : faults) names.insert(fault.name);
  EXPECT_EQ(names, (std::set<std::string>{"gait.t_ss", "gait.unknown", "hip.in_steps",
                                          "body.com_weight", "gait.t_ds"}));
  EXPECT_EQ(check_parameters(config, {{"gait.t_ss", 9.0}}).front().text,
            "is 9; allowed: 0.18 to 1.08 s");
}

TEST(ParameterTable, RulesBetweenParametersAreKeptToo) {
  const SimulationConfig config = config_of("kasaei", PlantKind::bullet);
  const auto faults = check_parameters(config, {{"adjust.freeze", 0.9}});
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults.front().name, "adjust.freeze");
  EXPECT_NE(faults.front().text.find("less than t_ss"), std::string::npos);
  // The rule is broken by a parameter that nobody has named.
  EXPECT_EQ(check_parameters(config, {{"step.min_width", 1.5}}).size(), 1U);
  EXPECT_EQ(
      check_parameters(
          config, {{"lqg.dcm_weight", 0.0}, {"lqg.com_weight", 0.0}, {"lqg.integral_weight", 0.0}})
          .size(),
      1U);
}

TEST(ParameterTable, ALivingWorldKeepsWhatTakesANewOne) {
  const ParameterValues wanted{{"gait.t_ss", 0.5}, {"lipm.noise", 0.001}};
  EXPECT_EQ(live_part(wanted, {{"lipm.delay", 0.01}, {"gait.t_ds", 0.2}}),
            (ParameterValues{{"gait.t_ss", 0.5}, {"lipm.delay", 0.01}}));
}

TEST(ParameterTable, ATrialIsRunWithItsParameters) {
  TrialSpec spec;
  spec.robot = "kasaei";
  spec.plant = PlantKind::lipm;
  spec.settle_s = 0.5;
  spec.observe_s = 2.0;
  const auto robot = load_robot("robots/kasaei");
  const TrialResult own = run_trial(spec, robot);
  for (const auto& [name, value] : ParameterValues{{"gait.t_ss", 0.5},
                                                   {"gait.com_height", 0.95},
                                                   {"lqg.zmp_weight", 100.0},
                                                   {"lipm.noise", 0.001}}) {
    spec.parameters = {{name, value}};
    const TrialResult other = run_trial(spec, robot);
    EXPECT_EQ(other.outcome, TrialOutcome::recovered) << name;
    EXPECT_NE(other.state_hash, own.state_hash) << name;
    EXPECT_EQ(other.state_hash, run_trial(spec, robot).state_hash) << name;
  }
  spec.parameters = {{"gait.t_ss", 9.0}};
  EXPECT_THROW(run_trial(spec, robot), std::invalid_argument);
}

}  // namespace
}  // namespace stagger::sim
