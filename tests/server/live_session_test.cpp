#include "server/live/live_session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

sim::SimulationConfig pendulum() {
  static const auto robot = sim::load_robot("robots/kasaei");
  sim::SimulationConfig config;
  config.robot = robot;
  config.plant = sim::PlantKind::lipm;
  return config;
}

CommandError::Kind kind_of(const std::function<void()>& command) {
  try {
    command();
  } catch (const CommandError& error) {
    return error.kind();
  }
  ADD_FAILURE() << "the command was carried out";
  return CommandError::Kind::failed;
}

/// Waits, with patience for a loaded machine, until the condition holds.
template <typename Condition>
bool eventually(Condition condition) {
  for (int i = 0; i < 3000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(10ms);
  }
  return false;
}

class LiveSessionTest : public ::testing::Test {
 protected:
  FrameHub hub_;
  LiveSession session_{pendulum(), hub_, false};
};

TEST_F(LiveSessionTest, TicksByItself) {
  EXPECT_TRUE(eventually([&] { return session_.state().tick > 100; }));
  EXPECT_TRUE(session_.state().running);
}

TEST_F(LiveSessionTest, APauseHoldsTime) {
  const Effect pause = session_.pause("test");
  EXPECT_EQ(session_.state().tick, pause.tick);
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(session_.state().tick, pause.tick);
  EXPECT_FALSE(session_.state().running);
  EXPECT_EQ(session_.resume("test").tick, pause.tick);
  EXPECT_TRUE(eventually([&] { return session_.state().tick > pause.tick + 10; }));
}

TEST_F(LiveSessionTest, AStepIsDoneWhenItIsAnswered) {
  const Effect pause = session_.pause("test");
  const Effect step = session_.step(2500, "test");
  EXPECT_EQ(step.tick, pause.tick + 2500);
  EXPECT_EQ(session_.state().tick, step.tick);
  EXPECT_DOUBLE_EQ(step.time_s, static_cast<double>(step.tick) * 0.001);
}

TEST_F(LiveSessionTest, AStepTakesAPause) {
  EXPECT_EQ(kind_of([&] { session_.step(1, "test"); }), CommandError::Kind::conflict);
}

TEST_F(LiveSessionTest, APushDeliversWhatWasAskedFor) {
  session_.pause("test");
  sim::PushSpec push;
  push.impulse_ns = 3.0;
  const sim::PushRecord record = session_.push(push, "test");
  EXPECT_EQ(record.created_tick, session_.state().tick);
  session_.step(300, "test");
  const sim::PushRecord after = session_.find_push(record.id);
  EXPECT_EQ(after.state, sim::PushState::done);
  EXPECT_EQ(after.start_tick, record.created_tick);
  EXPECT_NEAR(after.delivered.norm(), 3.0, 1e-9);
  EXPECT_EQ(kind_of([&] { session_.cancel_push(record.id, "test"); }),
            CommandError::Kind::conflict);
}

TEST_F(LiveSessionTest, APushCanBeCancelledAndListed) {
  sim::PushSpec push;
  push.impulse_ns = 3.0;
  push.trigger = sim::TimeTrigger{1e5};
  const std::uint64_t first = session_.push(push, "test").id;
  const std::uint64_t second = session_.push(push, "test").id;
  EXPECT_EQ(session_.cancel_push(first, "test").state, sim::PushState::cancelled);
  EXPECT_EQ(session_.cancel_push(first, "test").state, sim::PushState::cancelled);
  const auto page = session_.pushes(~0ULL, 10);
  ASSERT_EQ(page.size(), 2U);
  EXPECT_EQ(page[0].id, second);
  EXPECT_EQ(session_.pushes(second, 10).size(), 1U);
  EXPECT_EQ(session_.pushes(~0ULL, 1).size(), 1U);
  EXPECT_EQ(kind_of([&] { session_.find_push(99); }), CommandError::Kind::not_found);
  push.link = "tail";
  EXPECT_EQ(kind_of([&] { session_.push(push, "test"); }), CommandError::Kind::invalid);
}

TEST_F(LiveSessionTest, PushesThatWaitAreBounded) {
  sim::PushSpec push;
  push.impulse_ns = 1.0;
  push.trigger = sim::TimeTrigger{1e5};
  for (std::size_t i = 0; i < LiveSession::max_open_pushes; ++i) session_.push(push, "test");
  EXPECT_EQ(kind_of([&] { session_.push(push, "test"); }), CommandError::Kind::conflict);
  session_.cancel_push(1, "test");
  EXPECT_EQ(session_.push(push, "test").id, LiveSession::max_open_pushes + 1);
  session_.reset(pendulum(), "test");
  EXPECT_EQ(session_.push(push, "test").id, 1U);
}

TEST_F(LiveSessionTest, AResetIsANewWorld) {
  session_.pause("test");
  session_.step(100, "test");
  const SessionState before = session_.state();
  sim::SimulationConfig config = pendulum();
  config.seed = 5;
  EXPECT_EQ(session_.reset(config, "test").tick, 0U);
  const SessionState after = session_.state();
  EXPECT_NE(after.session_id, before.session_id);
  EXPECT_EQ(after.tick, 0U);
  EXPECT_EQ(after.seed, 5U);
  EXPECT_FALSE(after.running);
}

TEST_F(LiveSessionTest, TheSameCommandsAtTheSameTicksGiveTheSameWorld) {
  const auto play = [&] {
    session_.pause("test");
    session_.reset(pendulum(), "test");
    session_.walk({.vx = 0.1}, "test");
    session_.step(2000, "test");
    sim::PushSpec push;
    push.impulse_ns = 2.0;
    session_.push(push, "test");
    session_.step(2000, "test");
    return session_.state().state_hash;
  };
  EXPECT_EQ(play(), play());
}

TEST_F(LiveSessionTest, TheJournalMakesTheWorldAgain) {
  session_.pause("test");
  session_.reset(pendulum(), "test");
  session_.walk({.vx = 0.1}, "test");
  session_.step(1000, "test");
  sim::PushSpec push;
  push.impulse_ns = 2.0;
  session_.push(push, "test");
  session_.step(20, "test");
  session_.cancel_push(1, "test");
  session_.change_strategies(
      [](engine::Strategies present) {
        present.time = false;
        return present;
      },
      "test");
  session_.step(1000, "test");

  const SessionPtr session = hub_.session();
  const auto journal = session->journal->entries();
  ASSERT_EQ(journal.size(), 4U);
  sim::Simulation world(session->config);
  auto next = journal.begin();
  while (world.next_tick() < 2020) {
    for (; next != journal.end() && next->tick == world.next_tick(); ++next) {
      sim::apply(world, next->command);
    }
    world.step();
  }
  EXPECT_EQ(world.state_hash(), session_.state().state_hash);
  EXPECT_EQ(hub_.latest()->state_hash, session_.state().state_hash);

  session_.reset(pendulum(), "test");
  EXPECT_TRUE(hub_.session()->journal->entries().empty());
}

TEST_F(LiveSessionTest, CommandsAreAnsweredDuringALongStep) {
  session_.pause("test");
  const std::uint64_t start = session_.state().tick;
  std::thread stepper([&] { session_.step(LiveSession::max_step_ticks, "test"); });
  // Whether it comes before, during or after the step: it must not wait for patience to end.
  session_.change_strategies([](engine::Strategies s) { return s; }, "test");
  stepper.join();
  EXPECT_EQ(session_.state().tick, start + LiveSession::max_step_ticks);
}

TEST_F(LiveSessionTest, ManySendersAreAllAnswered) {
  std::vector<std::thread> senders;
  std::atomic<int> answered = 0;
  for (int t = 0; t < 8; ++t) {
    senders.emplace_back([&] {
      for (int i = 0; i < 20; ++i) {
        session_.walk({.vx = 0.01 * i}, "test");
        session_.state();
        ++answered;
      }
    });
  }
  for (std::thread& sender : senders) sender.join();
  EXPECT_EQ(answered, 160);
}

TEST_F(LiveSessionTest, CommandsAfterTheEndAreRefused) {
  session_.stop();
  EXPECT_EQ(kind_of([&] { session_.pause("test"); }), CommandError::Kind::stopping);
}

TEST_F(LiveSessionTest, TheEndAnswersAStepThatIsUnderWay) {
  session_.pause("test");
  std::atomic<int> ended = 0;
  std::vector<std::thread> steppers;
  for (int i = 0; i < 4; ++i) {
    steppers.emplace_back([&] {
      try {
        session_.step(LiveSession::max_step_ticks, "test");
      } catch (const CommandError&) {
      }
      ++ended;
    });
  }
  session_.stop();
  for (std::thread& stepper : steppers) stepper.join();
  EXPECT_EQ(ended, 4);
}

TEST_F(LiveSessionTest, SubscribersHearOfCommandsAndSteps) {
  session_.pause("test");
  const auto subscriber = hub_.add();
  Subscription subscription;
  subscription.rates = {1000.0};
  subscriber->subscribe(subscription, "ok", hub_.latest());
  session_.step(3, "someone");
  std::vector<std::uint64_t> ticks;
  std::string source;
  while (auto item = subscriber->next(std::chrono::steady_clock::now())) {
    if (const auto* data = std::get_if<DataItem>(&*item)) ticks.push_back(data->frame->frame.tick);
    if (const auto* event = std::get_if<EventPtr>(&*item)) source = (*event)->source;
  }
  EXPECT_EQ(source, "someone");
  ASSERT_GE(ticks.size(), 3U);
  EXPECT_EQ(ticks.back() + 1, session_.state().tick);
}

}  // namespace
}  // namespace stagger::server
