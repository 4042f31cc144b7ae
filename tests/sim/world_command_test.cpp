#include "sim/world_command.h"

#include <gtest/gtest.h>

#include <vector>

namespace stagger::sim {
namespace {

SimulationConfig pendulum() {
  static const auto robot = load_robot("robots/kasaei");
  SimulationConfig config;
  config.robot = robot;
  config.plant = PlantKind::lipm;
  return config;
}

PushSpec push_of(double impulse_ns) {
  PushSpec push;
  push.impulse_ns = impulse_ns;
  return push;
}

/// Both feet put down 10 cm farther.
std::vector<Footstep> forward(const Frame& frame) {
  std::vector<Footstep> steps;
  for (const Side side : {Side::right, Side::left}) {
    const FootPose& foot = frame.feet[engine::index(side)];
    const Vec2 ahead = engine::rotated(Vec2(0.1, 0.0), foot.yaw);
    steps.push_back({foot.position.head<2>() + ahead, foot.yaw, side});
  }
  return steps;
}

/// Runs a world of that configuration to `ticks`, applying the entries in their ticks.
std::uint64_t played(const std::vector<JournalEntry>& journal, std::uint64_t ticks) {
  Simulation world(pendulum());
  auto next = journal.begin();
  while (world.next_tick() < ticks) {
    for (; next != journal.end() && next->tick == world.next_tick(); ++next) {
      try {
        apply(world, next->command);
      } catch (const StepListRefused&) {
        // Without the stop before it, it does not stand.
      }
    }
    world.step();
  }
  return world.state_hash();
}

TEST(WorldCommand, EachOneActsAsTheCallItStandsFor) {
  Simulation called(pendulum());
  const auto run_to = [&called](std::uint64_t tick) {
    while (called.next_tick() < tick) called.step();
  };
  called.walk({.vx = 0.1});
  run_to(1500);
  called.push(push_of(2.0));
  run_to(1520);
  called.cancel_push(1);
  run_to(2500);
  called.set_strategies({.ankle = true, .hip = false, .step = false, .time = true});
  called.push(push_of(1.0));
  run_to(3500);
  called.stop_walking();
  run_to(6500);
  called.set_parameters({{"gait.t_ss", 0.5}});
  run_to(6600);
  const std::vector<Footstep> steps = forward(called.frame());
  called.follow(steps);
  run_to(9000);

  PushSpec first = push_of(2.0);
  const std::vector<JournalEntry> journal{
      {0, Walk{{.vx = 0.1}}},
      {1500, StartPush{first}},
      {1520, CancelPush{1}},
      {2500, SetStrategies{{.ankle = true, .hip = false, .step = false, .time = true}}},
      {2500, StartPush{push_of(1.0)}},
      {3500, StopWalking{}},
      {6500, SetParameters{{{"gait.t_ss", 0.5}}}},
      {6600, FollowSteps{steps}}};
  EXPECT_EQ(played(journal, 9000), called.state_hash());

  // Every one of them matters.
  for (std::size_t left_out = 0; left_out < journal.size(); ++left_out) {
    auto without = journal;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(left_out));
    EXPECT_NE(played(without, 9000), called.state_hash()) << "entry " << left_out;
  }
}

TEST(WorldCommand, APushOnNoLinkLeavesTheWorldAsItWas) {
  Simulation world(pendulum());
  PushSpec push = push_of(1.0);
  push.link = "tail";
  EXPECT_THROW(apply(world, StartPush{push}), std::invalid_argument);
  EXPECT_TRUE(world.pushes().empty());
}

}  // namespace
}  // namespace stagger::sim
