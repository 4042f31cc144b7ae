#include "server/json/world_json.h"

#include <gtest/gtest.h>

namespace stagger::server {
namespace {

nlohmann::json plain(const Json& json) { return nlohmann::json::parse(json.dump()); }

TEST(WorldJson, AConfigurationReadsBackAsItWas) {
  sim::SimulationConfig config;
  config.robot = sim::load_robot("robots/kasaei");
  config.seed = 77;
  config.strategies.hip = false;
  config.senses.perfect_state = true;
  config.senses.control_delay = 0.003;
  config.terrain.kind = sim::TerrainKind::slope;
  config.terrain.slope_angle = 0.0523;
  config.physics.self_collision = false;
  config.parameters = {{"gait.t_ss", 1.0 / 3.0}};
  const Json json = world_json(config);
  sim::JsonErrors errors;
  WorldSpec read;
  sim::read_json(plain(json), errors, [&read](sim::JsonReader& in) { read = read_world(in); });
  ASSERT_TRUE(errors.empty());
  EXPECT_EQ(read.robot, "kasaei");
  EXPECT_EQ(read.config.terrain.slope_angle, config.terrain.slope_angle);
  read.config.robot = config.robot;
  EXPECT_EQ(world_json(read.config), json);
}

TEST(WorldJson, EveryCommandReadsBackAsItWas) {
  sim::PushSpec push;
  push.link = "torso";
  push.direction = sim::horizontal_direction(33.0);
  push.impulse_ns = 1.0 / 3.0;
  push.trigger = sim::TimeTrigger{0.1};
  for (const sim::WorldCommand& command :
       {sim::WorldCommand(sim::Walk{{.vx = 0.1, .vy = -0.2, .wz = 0.3}}),
        sim::WorldCommand(sim::StopWalking{}),
        sim::WorldCommand(
            sim::SetStrategies{{.ankle = false, .hip = true, .step = false, .time = true}}),
        sim::WorldCommand(sim::StartPush{push}), sim::WorldCommand(sim::CancelPush{7}),
        sim::WorldCommand(sim::FollowSteps{{{{0.1 / 3.0, -0.1}, 1.0 / 3.0, sim::Side::right}}}),
        sim::WorldCommand(sim::SetParameters{{{"gait.t_ss", 1.0 / 3.0}, {"hip.in_steps", 1.0}}})}) {
    const Json json = command_json(command);
    sim::JsonErrors errors;
    std::optional<sim::WorldCommand> read;
    sim::read_json(plain(json), errors, [&read](sim::JsonReader& in) { read = read_command(in); });
    ASSERT_TRUE(errors.empty()) << json;
    ASSERT_TRUE(read);
    EXPECT_EQ(read->index(), command.index());
    EXPECT_EQ(command_json(*read), json);
  }
}

TEST(WorldJson, WhatIsNoCommandIsRefused) {
  for (const char* text : {"{}", R"({"fly":{}})", R"({"push":{"impulse_ns":-1}})"}) {
    sim::JsonErrors errors;
    sim::read_json(nlohmann::json::parse(text), errors,
                   [](sim::JsonReader& in) { read_command(in); });
    EXPECT_FALSE(errors.empty()) << text;
  }
}

}  // namespace
}  // namespace stagger::server
