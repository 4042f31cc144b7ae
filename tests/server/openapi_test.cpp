#include "server/http/openapi.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace stagger::server {
namespace {

TEST(OpenApi, JoinsPiecesIntoOneDocument) {
  const Json document = openapi_document(
      {{"a.json", R"({"openapi":"3.1.0","tags":[{"name":"a"}],"paths":{"/a":{"get":{}}}})"},
       {"b.json", R"({"tags":[{"name":"b"}],"paths":{"/a":{"post":{}},"/b":{"get":{}}}})"}},
      "1.2.3");
  EXPECT_EQ(document["info"]["version"], "1.2.3");
  EXPECT_EQ(document["tags"].size(), 2U);
  EXPECT_TRUE(document["paths"]["/a"].contains("get"));
  EXPECT_TRUE(document["paths"]["/a"].contains("post"));
  EXPECT_TRUE(document["paths"].contains("/b"));
}

TEST(OpenApi, WhatTwoPiecesSayIsAnErrorThatNamesTheFile) {
  try {
    openapi_document({{"a.json", R"({"paths":{"/a":{"get":{"summary":"one"}}}})"},
                      {"b.json", R"({"paths":{"/a":{"get":{"summary":"two"}}}})"}},
                     "1");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("b.json: /paths//a/get/summary"));
  }
}

TEST(OpenApi, APieceThatIsNoJsonIsAnErrorThatNamesTheFile) {
  try {
    openapi_document({{"broken.json", "{"}}, "1");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("broken.json"));
  }
}

TEST(OpenApi, ThePiecesOfTheProgramGoTogether) {
  const Json document = openapi_document(openapi_pieces(), "1");
  EXPECT_EQ(document["openapi"], "3.1.0");
  EXPECT_TRUE(document["paths"].contains("/api/v1/pushes"));
}

}  // namespace
}  // namespace stagger::server
