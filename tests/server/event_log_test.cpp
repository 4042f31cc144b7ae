#include "server/live/event_log.h"

#include <gtest/gtest.h>

namespace stagger::server {
namespace {

EventPtr event(std::uint64_t tick, const std::string& kind) {
  auto message = std::make_shared<EventMessage>();
  message->tick = tick;
  message->kind = kind;
  return message;
}

TEST(EventLog, FindsByKindTickAndPage) {
  EventLog log;
  for (std::uint64_t tick = 0; tick < 10; ++tick) log.add(event(tick, tick % 2 ? "step" : "push"));
  EventQuery query;
  EXPECT_EQ(log.find(query).size(), 10U);
  EXPECT_EQ(log.find(query).front().event->tick, 9U);
  query.kind = "step";
  query.limit = 2;
  const auto page = log.find(query);
  ASSERT_EQ(page.size(), 2U);
  EXPECT_EQ(page[1].event->tick, 7U);
  query.before = page[1].id;
  EXPECT_EQ(log.find(query)[0].event->tick, 5U);
  query.since_tick = 4;
  EXPECT_EQ(log.find(query).size(), 1U);
}

TEST(EventLog, IsBoundedAndNumbersGoOnOverSessions) {
  EventLog log;
  for (std::size_t i = 0; i < EventLog::capacity + 5; ++i) log.add(event(i, "step"));
  EventQuery query;
  query.limit = 2 * EventLog::capacity;
  EXPECT_EQ(log.find(query).size(), EventLog::capacity);
  EXPECT_EQ(log.forgotten(), 5U);
  const std::uint64_t newest = log.find(query).front().id;
  log.clear();
  EXPECT_TRUE(log.find(query).empty());
  EXPECT_EQ(log.forgotten(), 0U);
  log.add(event(0, "step"));
  EXPECT_EQ(log.find(query).front().id, newest + 1);
}

}  // namespace
}  // namespace stagger::server
