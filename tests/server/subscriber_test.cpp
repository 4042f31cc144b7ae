#include "server/live/subscriber.h"

#include <gmock/gmock.h>

#include <thread>

#include "server/live/decimation.h"
#include "server/live/frame_hub.h"

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

SessionPtr same_session() { return std::make_shared<const SessionInfo>(); }

FramePtr frame(const SessionPtr& of, std::uint64_t tick) {
  auto message = std::make_shared<FrameMessage>();
  message->session = of;
  message->frame.tick = tick;
  return message;
}

EventPtr event(std::uint64_t tick) {
  auto message = std::make_shared<EventMessage>();
  message->tick = tick;
  return message;
}

Subscription at(double rate_hz) {
  Subscription subscription;
  subscription.rates = {rate_hz};
  return subscription;
}

std::vector<StreamItem> drain(Subscriber& subscriber) {
  std::vector<StreamItem> items;
  while (auto item = subscriber.next(std::chrono::steady_clock::now())) {
    items.push_back(std::move(*item));
  }
  return items;
}

std::vector<std::uint64_t> ticks(const std::vector<StreamItem>& items) {
  std::vector<std::uint64_t> list;
  for (const StreamItem& item : items) {
    if (const auto* data = std::get_if<DataItem>(&item)) list.push_back(data->frame->frame.tick);
  }
  return list;
}

std::vector<std::uint64_t> seqs(const std::vector<StreamItem>& items) {
  std::vector<std::uint64_t> list;
  for (const StreamItem& item : items) {
    if (const auto* data = std::get_if<DataItem>(&item)) list.push_back(data->seq);
  }
  return list;
}

TEST(Decimation, SendsAsManyFramesASecondAsAskedFor) {
  for (const double rate : {1.0, 7.0, 60.0, 99.9, 100.0, 333.0, 1000.0}) {
    int sent = 0;
    for (std::uint64_t tick = 1; tick <= 10000; ++tick) sent += is_due(tick, rate, 0.001);
    EXPECT_EQ(sent, static_cast<int>(rate * 10.0)) << rate;
  }
}

TEST(Decimation, TheGapsAreEven) {
  std::uint64_t last = 0;
  for (std::uint64_t tick = 1; tick <= 5000; ++tick) {
    if (!is_due(tick, 60.0, 0.001)) continue;
    EXPECT_GE(tick - last, 16U);
    EXPECT_LE(tick - last, 17U);
    last = tick;
  }
}

TEST(Decimation, StaysExactAfterDays) {
  const std::uint64_t days = 10ULL * 86400 * 1000;
  int sent = 0;
  for (std::uint64_t tick = days + 1; tick <= days + 1000; ++tick) {
    sent += is_due(tick, 100.0, 0.001);
  }
  EXPECT_EQ(sent, 100);
}

TEST(Subscriber, TellsNothingButTheSessionBeforeItIsSubscribed) {
  Subscriber subscriber;
  const SessionPtr here = same_session();
  subscriber.start_session(here);
  subscriber.offer(frame(here, 0), true);
  subscriber.offer(event(0));
  const auto items = drain(subscriber);
  ASSERT_EQ(items.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<SessionPtr>(items[0]));
}

TEST(Subscriber, AnswersFirstThenSendsTheLatestFrame) {
  Subscriber subscriber;
  const SessionPtr here = same_session();
  subscriber.start_session(here);
  subscriber.subscribe(at(10), "answer", frame(here, 5));
  const auto items = drain(subscriber);
  ASSERT_EQ(items.size(), 3U);
  EXPECT_EQ(std::get<ReplyItem>(items[1]).text, "answer");
  EXPECT_EQ(ticks(items), std::vector<std::uint64_t>{5});
}

TEST(Subscriber, FramesAndEventsKeepTheirOrder) {
  Subscriber subscriber;
  const SessionPtr here = same_session();
  subscriber.start_session(here);
  subscriber.subscribe(at(1000), "", nullptr);
  drain(subscriber);
  subscriber.offer(frame(here, 1), false);
  subscriber.offer(event(1));
  subscriber.offer(frame(here, 2), false);
  const auto items = drain(subscriber);
  ASSERT_EQ(items.size(), 3U);
  EXPECT_TRUE(std::holds_alternative<DataItem>(items[0]));
  EXPECT_TRUE(std::holds_alternative<EventPtr>(items[1]));
  EXPECT_TRUE(std::holds_alternative<DataItem>(items[2]));
}

TEST(Subscriber, DropsTheOldestFramesCountsThemAndLeavesAGap) {
  Subscriber subscriber;
  const SessionPtr here = same_session();
  subscriber.start_session(here);
  subscriber.subscribe(at(1000), "", nullptr);
  std::size_t dropped = 0;
  for (std::uint64_t tick = 1; tick <= 1300; ++tick) {
    dropped += subscriber.offer(frame(here, tick), false);
  }
  EXPECT_EQ(dropped, 300U);
  EXPECT_EQ(subscriber.dropped(), 300U);
  const auto items = drain(subscriber);
  EXPECT_EQ(ticks(items).front(), 301U);
  EXPECT_EQ(ticks(items).back(), 1300U);
  EXPECT_EQ(seqs(items).front(), 300U);  // 0 to 299 are the gap
}

TEST(Subscriber, SeqHasNoGapWhenTheSubscriptionChanges) {
  Subscriber subscriber;
  const SessionPtr here = same_session();
  subscriber.start_session(here);
  subscriber.subscribe(at(1000), "", nullptr);
  subscriber.offer(frame(here, 1), false);
  subscriber.subscribe(at(500), "", nullptr);
  subscriber.offer(frame(here, 2), false);
  subscriber.offer(frame(here, 3), false);
  subscriber.offer(frame(here, 4), false);
  const auto items = drain(subscriber);
  EXPECT_THAT(ticks(items), ::testing::ElementsAre(1, 2, 4));
  EXPECT_THAT(seqs(items), ::testing::ElementsAre(0, 1, 2));
}

TEST(Subscriber, KeepsEveryEventUntilTheyOverflowThenTellsTheClientToGo) {
  Subscriber subscriber;
  subscriber.start_session(same_session());
  subscriber.subscribe(at(1), "", nullptr);
  drain(subscriber);
  for (std::uint64_t i = 0; i < Subscriber::max_lossless; ++i) subscriber.offer(event(i));
  EXPECT_FALSE(subscriber.overflowed());
  subscriber.offer(event(0));
  EXPECT_TRUE(subscriber.overflowed());
  const auto item = subscriber.next(std::chrono::steady_clock::now());
  ASSERT_TRUE(item && std::holds_alternative<CloseItem>(*item));
  EXPECT_EQ(std::get<CloseItem>(*item).code, 1013);
}

TEST(Subscriber, FramesOfAnotherSessionAreNotShown) {
  Subscriber subscriber;
  const SessionPtr old = same_session();
  const SessionPtr here = same_session();
  subscriber.start_session(old);
  subscriber.subscribe(at(1000), "", nullptr);
  subscriber.start_session(here);
  drain(subscriber);
  subscriber.offer(frame(old, 9), true);
  EXPECT_TRUE(drain(subscriber).empty());
  subscriber.offer(frame(here, 0), true);
  EXPECT_EQ(drain(subscriber).size(), 1U);
}

TEST(Subscriber, TheSameFrameIsNotSentTwice) {
  Subscriber subscriber;
  const SessionPtr here = same_session();
  subscriber.start_session(here);
  subscriber.subscribe(at(1000), "", nullptr);
  drain(subscriber);
  const FramePtr last = frame(here, 1);
  subscriber.offer(last, false);
  subscriber.offer(last, true);  // a pause right after
  EXPECT_EQ(drain(subscriber).size(), 1U);
}

TEST(Subscriber, AClosePassesEverythingElse) {
  Subscriber subscriber;
  subscriber.start_session(same_session());
  subscriber.close(1001, "bye");
  subscriber.close(1008, "later");
  const auto item = subscriber.next(std::chrono::steady_clock::now());
  ASSERT_TRUE(item && std::holds_alternative<CloseItem>(*item));
  EXPECT_EQ(std::get<CloseItem>(*item).code, 1001);
}

TEST(Subscriber, FinishWakesTheWriter) {
  Subscriber subscriber;
  std::thread reader([&subscriber] { subscriber.finish(); });
  EXPECT_FALSE(subscriber.next(std::chrono::steady_clock::now() + 60s));
  EXPECT_TRUE(subscriber.finished());
  reader.join();
}

TEST(FrameHub, TwoClientsOfOneRateSeeTheSame) {
  FrameHub hub;
  const SessionPtr here = same_session();
  hub.start_session(here);
  const auto a = hub.add();
  const auto b = hub.add();
  a->subscribe(at(60), "", nullptr);
  b->subscribe(at(60), "", nullptr);
  for (std::uint64_t tick = 1; tick < 200; ++tick) hub.publish(frame(here, tick), false);
  EXPECT_EQ(ticks(drain(*a)), ticks(drain(*b)));
  EXPECT_EQ(hub.counters().clients, 2U);
  hub.remove(a);
  EXPECT_EQ(hub.counters().clients, 1U);
}

TEST(FrameHub, ALatecomerIsToldOfTheSessionAndOfTheEnd) {
  FrameHub hub;
  hub.start_session(same_session());
  hub.close_all(1001, "bye");
  const auto late = hub.add();
  const auto item = late->next(std::chrono::steady_clock::now());
  ASSERT_TRUE(item && std::holds_alternative<CloseItem>(*item));
}

TEST(FrameHub, ASlowClientCostsOnlyItself) {
  FrameHub hub;
  const SessionPtr here = same_session();
  hub.start_session(here);
  const auto slow = hub.add();
  const auto good = hub.add();
  slow->subscribe(at(1000), "", nullptr);
  good->subscribe(at(1000), "", nullptr);
  std::size_t seen = 0;
  for (std::uint64_t tick = 1; tick <= 5000; ++tick) {
    hub.publish(frame(here, tick), false);
    seen += ticks(drain(*good)).size();
  }
  EXPECT_EQ(seen, 5000U);
  EXPECT_EQ(good->dropped(), 0U);
  EXPECT_EQ(slow->dropped(), 4000U);
  EXPECT_EQ(hub.counters().dropped_messages, 4000U);
}

}  // namespace
}  // namespace stagger::server
