#include "server/http/problem.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace stagger::server {
namespace {

TEST(Problem, NamesEveryField) {
  sim::JsonErrors errors;
  errors.add("/impulse_ns", "is -3; allowed: more than 0 to 200 N s");
  const HttpResponse response = to_response(Problem(errors));
  EXPECT_EQ(response.status, 422);
  EXPECT_EQ(response.content_type, "application/problem+json");
  const auto body = nlohmann::json::parse(response.body);
  EXPECT_EQ(body["type"], "about:blank");
  EXPECT_EQ(body["status"], 422);
  EXPECT_EQ(body["detail"], "1 field is not as it should be");
  EXPECT_EQ(body["errors"][0]["pointer"], "/impulse_ns");
  EXPECT_EQ(body["errors"][0]["detail"], "is -3; allowed: more than 0 to 200 N s");
}

TEST(Problem, SurvivesTextThatIsNotUtf8) {
  const HttpResponse response = to_response(Problem(404, "there is nothing at /\xff\xfe"));
  EXPECT_EQ(nlohmann::json::parse(response.body)["status"], 404);
}

TEST(Problem, EveryKindOfFailedCommandHasItsStatus) {
  using Kind = CommandError::Kind;
  const auto status = [](Kind kind) { return to_problem(CommandError(kind, "x")).status; };
  EXPECT_EQ(status(Kind::conflict), 409);
  EXPECT_EQ(status(Kind::not_found), 404);
  EXPECT_EQ(status(Kind::invalid), 422);
  EXPECT_EQ(status(Kind::timeout), 504);
  EXPECT_EQ(status(Kind::failed), 500);
  EXPECT_EQ(status(Kind::busy), 503);
  EXPECT_EQ(status(Kind::stopping), 503);
}

TEST(Problem, AFullQueueSaysWhenToComeBack) {
  const Problem problem = to_problem(CommandError(CommandError::Kind::busy, "full"));
  ASSERT_EQ(problem.headers.size(), 1U);
  EXPECT_EQ(problem.headers[0].first, "Retry-After");
}

}  // namespace
}  // namespace stagger::server
