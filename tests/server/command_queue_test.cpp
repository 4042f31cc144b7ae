#include "server/live/command_queue.h"

#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "server/live/ticket.h"

namespace stagger::server {
namespace {

using namespace std::chrono_literals;
using Queue = CommandQueue<int>;

TEST(CommandQueue, KeepsTheOrder) {
  Queue queue(8);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(queue.push(i), Queue::Push::taken);
  EXPECT_THAT(queue.take(), ::testing::ElementsAre(0, 1, 2, 3, 4));
  EXPECT_TRUE(queue.take().empty());
}

TEST(CommandQueue, RefusesWhenFullAndTakesAgainWhenEmptied) {
  Queue queue(2);
  EXPECT_EQ(queue.push(1), Queue::Push::taken);
  EXPECT_EQ(queue.push(2), Queue::Push::taken);
  EXPECT_EQ(queue.push(3), Queue::Push::full);
  queue.take();
  EXPECT_EQ(queue.push(4), Queue::Push::taken);
}

TEST(CommandQueue, WhatWaitsWhenItClosesCanStillBeTaken) {
  Queue queue(2);
  queue.push(1);
  queue.close();
  EXPECT_EQ(queue.push(2), Queue::Push::closed);
  EXPECT_THAT(queue.take(), ::testing::ElementsAre(1));
}

TEST(CommandQueue, WakesWhoWaits) {
  Queue queue(2);
  std::thread sender([&queue] { queue.push(1); });
  queue.wait(60s);
  EXPECT_EQ(queue.take().size(), 1U);
  sender.join();
  std::thread closer([&queue] { queue.close(); });
  queue.wait(60s);
  EXPECT_TRUE(queue.closed());
  closer.join();
}

TEST(CommandQueue, LosesNothingBetweenThreads) {
  Queue queue(64);
  std::atomic<int> refused = 0;
  std::vector<std::thread> senders;
  for (int t = 0; t < 4; ++t) {
    senders.emplace_back([&] {
      for (int i = 0; i < 1000; ++i) {
        while (queue.push(1) == Queue::Push::full) {
          ++refused;
          std::this_thread::yield();
        }
      }
    });
  }
  std::size_t taken = 0;
  while (taken < 4000) {
    queue.wait(1s);
    taken += queue.take().size();
  }
  for (std::thread& sender : senders) sender.join();
  EXPECT_EQ(taken, 4000U);
}

TEST(Ticket, HandsTheAnswerOver) {
  Ticket<int> ticket;
  std::thread other([&ticket] {
    ASSERT_TRUE(ticket.claim());
    ticket.answer(7);
  });
  EXPECT_EQ(ticket.wait(60s), 7);
  other.join();
}

TEST(Ticket, HandsTheErrorOver) {
  Ticket<int> ticket;
  ticket.fail(CommandError(CommandError::Kind::conflict, "no"));
  try {
    ticket.wait(60s);
    FAIL();
  } catch (const CommandError& error) {
    EXPECT_EQ(error.kind(), CommandError::Kind::conflict);
    EXPECT_STREQ(error.what(), "no");
  }
}

TEST(Ticket, ACommandWhoseSenderHasGivenUpIsNotCarriedOut) {
  Ticket<int> ticket;
  EXPECT_THROW(ticket.wait(1ms), CommandError);
  EXPECT_FALSE(ticket.claim());
}

}  // namespace
}  // namespace stagger::server
