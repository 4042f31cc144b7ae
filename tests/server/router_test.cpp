#include "server/http/router.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "server/http/problem.h"

namespace stagger::server {
namespace {

Router make() {
  Router router;
  const auto say = [](const std::string& text) {
    return [text](const HttpRequest&) { return HttpResponse{200, "text/plain", text, {}}; };
  };
  router.add("GET", "/api/v1/things", say("list"));
  router.add("POST", "/api/v1/things", say("create"));
  router.add("GET", "/api/v1/things/{id}", [](const HttpRequest& request) {
    return HttpResponse{200, "text/plain", request.parameters.at("id"), {}};
  });
  router.add("GET", "/api/v1/things/{id}/files/{path...}", [](const HttpRequest& request) {
    return HttpResponse{200, "text/plain", request.parameters.at("path"), {}};
  });
  router.add("POST", "/api/v1/fail",
             [](const HttpRequest&) -> HttpResponse { throw std::runtime_error("broken"); });
  router.add("POST", "/api/v1/busy", [](const HttpRequest&) -> HttpResponse {
    throw CommandError(CommandError::Kind::busy, "full");
  });
  router.set_fallback(say("file"));
  return router;
}

HttpResponse ask(const std::string& method, const std::string& path) {
  HttpRequest request;
  request.method = method;
  request.path = path;
  return make().handle(request);
}

std::string header(const HttpResponse& response, const std::string& name) {
  for (const auto& [key, value] : response.headers) {
    if (key == name) return value;
  }
  return "";
}

TEST(Router, FindsTheHandler) {
  EXPECT_EQ(ask("GET", "/api/v1/things").body, "list");
  EXPECT_EQ(ask("HEAD", "/api/v1/things").body, "list");
  EXPECT_EQ(ask("POST", "/api/v1/things").body, "create");
  EXPECT_EQ(ask("GET", "/api/v1/things/7").body, "7");
  EXPECT_EQ(ask("GET", "/api/v1/things/7/files/a/b.urdf").body, "a/b.urdf");
}

TEST(Router, TellsItsTableAndWhichRouteAnswered) {
  EXPECT_EQ(make().table().size(), 6U);
  EXPECT_EQ(make().table()[2], "GET /api/v1/things/{id}");
  EXPECT_EQ(ask("GET", "/api/v1/things/7").route, "/api/v1/things/{id}");
  EXPECT_EQ(ask("POST", "/api/v1/fail").route, "/api/v1/fail");
  EXPECT_EQ(ask("DELETE", "/api/v1/things").route, "/api/v1/things");
  EXPECT_EQ(ask("GET", "/api/v1/nothing").route, "");
}

TEST(Router, TellsAnUnknownPathFromAWrongMethod) {
  EXPECT_EQ(ask("GET", "/api/v1/nothing").status, 404);
  EXPECT_EQ(ask("POST", "/api/v1/nothing").status, 404);
  EXPECT_EQ(ask("GET", "/api/v1/things/").status, 404);
  EXPECT_EQ(ask("GET", "/api/v1/things/7/more").status, 404);
  const HttpResponse wrong = ask("DELETE", "/api/v1/things");
  EXPECT_EQ(wrong.status, 405);
  EXPECT_EQ(header(wrong, "Allow"), "GET, HEAD, POST");
  EXPECT_EQ(header(ask("GET", "/api/v1/busy"), "Allow"), "POST");
}

TEST(Router, AsksTheFallbackForFilesOnly) {
  EXPECT_EQ(ask("GET", "/").body, "file");
  EXPECT_EQ(ask("GET", "/assets/x.js").body, "file");
  EXPECT_EQ(ask("POST", "/").status, 405);
}

TEST(Router, WhatAHandlerThrowsBecomesAProblem) {
  EXPECT_EQ(ask("POST", "/api/v1/fail").status, 500);
  EXPECT_EQ(ask("POST", "/api/v1/fail").content_type, "application/problem+json");
  EXPECT_EQ(ask("POST", "/api/v1/busy").status, 503);
}

}  // namespace
}  // namespace stagger::server
