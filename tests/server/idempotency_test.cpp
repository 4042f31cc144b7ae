#include "server/http/idempotency.h"

#include <gtest/gtest.h>

#include "server/http/problem.h"

namespace stagger::server {
namespace {

HttpRequest request_of(const std::string& key, const std::string& body) {
  HttpRequest request;
  if (!key.empty()) request.headers["idempotency-key"] = key;
  request.body = body;
  return request;
}

class IdempotencyTest : public ::testing::Test {
 protected:
  HttpResponse run(const std::string& key, const std::string& body) {
    return answers_.run(request_of(key, body), [this] {
      ++runs_;
      HttpResponse response;
      response.status = 201;
      response.body = std::to_string(runs_);
      return response;
    });
  }
  int status_of(const std::string& key, const std::string& body) {
    try {
      return run(key, body).status;
    } catch (const Problem& problem) {
      return problem.status;
    }
  }

  Idempotency answers_;
  int runs_ = 0;
};

TEST_F(IdempotencyTest, TheSameRequestGetsTheSameAnswerAndIsRunOnce) {
  EXPECT_EQ(run("a", "{}").body, "1");
  const HttpResponse again = run("a", "{}");
  EXPECT_EQ(again.body, "1");
  EXPECT_EQ(again.status, 201);
  EXPECT_EQ(again.headers.back().first, "Idempotency-Replayed");
  EXPECT_EQ(run("b", "{}").body, "2");
  EXPECT_EQ(runs_, 2);
}

TEST_F(IdempotencyTest, WithoutAKeyEachIsRun) {
  run("", "{}");
  run("", "{}");
  EXPECT_EQ(runs_, 2);
}

TEST_F(IdempotencyTest, AnotherBodyIsRefusedAndSoIsABadKey) {
  run("a", "{}");
  EXPECT_EQ(status_of("a", "{ }"), 422);
  EXPECT_EQ(status_of("two words", "{}"), 422);
  EXPECT_EQ(status_of(std::string(129, 'k'), "{}"), 422);
  EXPECT_EQ(runs_, 1);
}

TEST_F(IdempotencyTest, WhatFailedMayBeSentAgain) {
  const auto fail = [this] {
    return answers_.run(request_of("a", "{}"),
                        []() -> HttpResponse { throw Problem(422, "no such link"); });
  };
  EXPECT_THROW(fail(), Problem);
  EXPECT_EQ(run("a", "other").status, 201);
}

TEST_F(IdempotencyTest, WhileTheFirstIsUnderWayTheSecondIsToldSo) {
  int inner = 0;
  answers_.run(request_of("a", "{}"), [&] {
    inner = status_of("a", "{}");
    return HttpResponse();
  });
  EXPECT_EQ(inner, 409);
}

TEST_F(IdempotencyTest, TheOldestAreForgottenByNumberAndBySize) {
  for (std::size_t i = 0; i <= Idempotency::max_kept; ++i) run("k" + std::to_string(i), "{}");
  const int before = runs_;
  run("k1", "{}");  // still there
  EXPECT_EQ(runs_, before);
  run("k0", "{}");
  EXPECT_EQ(runs_, before + 1);
  const std::string large(Idempotency::max_bytes / 2, 'x');
  run("large1", large);
  run("large2", large);
  const int then = runs_;
  run("large2", large);
  EXPECT_EQ(runs_, then);
  run("large1", large);
  EXPECT_EQ(runs_, then + 1);
}

}  // namespace
}  // namespace stagger::server
