#include "server/http/access.h"

#include <gtest/gtest.h>

#include <set>

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

const std::string full = "a-key-that-commands";
const std::string read_only = "a-key-that-may-only-look";

HttpRequest request(const std::string& method, const std::string& path,
                    std::map<std::string, std::string> headers = {}) {
  HttpRequest result;
  result.method = method;
  result.path = path;
  result.headers = std::move(headers);
  return result;
}

/// 0 when the request may pass.
int status(const Access& access, const HttpRequest& asked) {
  const auto problem = access.refusal(asked);
  return problem ? problem->status : 0;
}

TEST(Access, ComparesWholeKeys) {
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  for (const char* given : {"", "ab", "abd", "abca", "abcabc", "ABC"}) {
    EXPECT_FALSE(equal_in_constant_time(given, "abc")) << given;
  }
  EXPECT_FALSE(equal_in_constant_time("", "")) << "no key opens nothing";
}

TEST(Access, WithoutAKeyEverythingIsOpen) {
  const Access access({});
  EXPECT_FALSE(access.asks_for_a_key());
  EXPECT_EQ(status(access, request("POST", "/api/v1/pushes")), 0);
}

TEST(Access, TheKeyComesInEitherHeader) {
  const Access access({full, read_only});
  const auto with = [&](std::map<std::string, std::string> headers) {
    return status(access, request("POST", "/api/v1/pushes", std::move(headers)));
  };
  EXPECT_EQ(with({{"authorization", "Bearer " + full}}), 0);
  EXPECT_EQ(with({{"authorization", "bearer " + full}}), 0);
  EXPECT_EQ(with({{"x-api-key", full}}), 0);
  EXPECT_EQ(with({}), 401);
  EXPECT_EQ(with({{"authorization", full}}), 401);
  EXPECT_EQ(with({{"authorization", "Basic " + full}}), 401);
  EXPECT_EQ(with({{"authorization", "Bearer"}}), 401);
  EXPECT_EQ(with({{"x-api-key", full + "x"}}), 401);
}

TEST(Access, TheReadOnlyKeyLooks) {
  const Access access({full, read_only});
  const auto with = [&](const std::string& method, const std::string& path) {
    return status(access, request(method, path, {{"x-api-key", read_only}}));
  };
  EXPECT_EQ(with("GET", "/api/v1/simulation"), 0);
  EXPECT_EQ(with("HEAD", "/api/v1/simulation"), 0);
  EXPECT_EQ(with("POST", "/api/v1/tickets"), 0);
  for (const char* method : {"POST", "PUT", "PATCH", "DELETE", "get"}) {
    EXPECT_EQ(with(method, "/api/v1/pushes"), 403) << method;
  }
}

TEST(Access, WithoutAReadOnlyKeyAnEmptyOneOpensNothing) {
  const Access access({full, ""});
  EXPECT_EQ(status(access, request("GET", "/api/v1/simulation", {{"x-api-key", ""}})), 401);
}

TEST(Access, ThePageAndTheProbesAreOpen) {
  const Access access({full, ""});
  for (const char* path : {"/", "/assets/index.js", "/health", "/ready"}) {
    EXPECT_EQ(status(access, request("GET", path)), 0) << path;
  }
  for (const char* path : {"/api/v1/simulation", "/api/v1/stream", "/api/v2/x", "/metrics"}) {
    EXPECT_EQ(status(access, request("GET", path)), 401) << path;
  }
}

TEST(Access, ATicketWorksOnce) {
  Access access({full, ""});
  const auto now = Access::Clock::now();
  const std::string ticket = access.issue_ticket(now);
  EXPECT_EQ(ticket.size(), 32U);
  EXPECT_FALSE(access.redeem(ticket.substr(1), now));
  EXPECT_FALSE(access.redeem("", now));
  EXPECT_TRUE(access.redeem(ticket, now + 1s));
  EXPECT_FALSE(access.redeem(ticket, now + 1s));
}

TEST(Access, ATicketDies) {
  Access access({full, ""});
  const auto now = Access::Clock::now();
  const std::string ticket = access.issue_ticket(now);
  EXPECT_FALSE(access.redeem(ticket, now + Access::ticket_life + 1s));
}

TEST(Access, TicketsDifferAndAreBounded) {
  Access access({full, ""});
  const auto now = Access::Clock::now();
  const std::string first = access.issue_ticket(now);
  std::set<std::string> tickets;
  for (std::size_t i = 0; i < Access::max_tickets; ++i) tickets.insert(access.issue_ticket(now));
  EXPECT_EQ(tickets.size(), Access::max_tickets);
  EXPECT_FALSE(access.redeem(first, now)) << "the oldest has made room";
  EXPECT_TRUE(access.redeem(*tickets.begin(), now));
}

TEST(Access, KnowsWhatCannotBeAKey) {
  EXPECT_FALSE(why_no_key("0123456789abcdef"));
  EXPECT_TRUE(why_no_key(""));
  EXPECT_TRUE(why_no_key("short"));
  EXPECT_TRUE(why_no_key("0123456789 abcdef"));
  EXPECT_TRUE(why_no_key("0123456789abcd\xc3\xa9"));
  EXPECT_TRUE(why_no_key(std::string(513, 'x')));
}

}  // namespace
}  // namespace stagger::server
