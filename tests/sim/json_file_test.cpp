#include "sim/json_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace stagger::sim {
namespace {

using ::testing::HasSubstr;

JsonSyntaxError syntax_error(const std::string& text) {
  try {
    parse_json(text);
  } catch (const JsonSyntaxError& error) {
    return error;
  }
  return {0, 0, "no error"};
}

TEST(JsonFile, SyntaxErrorsHaveAPlace) {
  const JsonSyntaxError error = syntax_error("{\n  \"a\": 1,\n  \"b\": ,\n}");
  EXPECT_EQ(error.line, 3u);
  EXPECT_EQ(error.column, 8u);
  EXPECT_THAT(error.what(), HasSubstr("unexpected ','"));
  EXPECT_EQ(syntax_error("").line, 1u);
  EXPECT_EQ(syntax_error("{} x").column, 4u);
}

TEST(JsonFile, RefusesWhatTheGrammarLeavesOpen) {
  const JsonSyntaxError twice = syntax_error("{\"a\": 1,\n \"b\": {\"a\": 2},\n \"a\": 3}");
  EXPECT_STREQ(twice.what(), "'a' is given twice");
  EXPECT_EQ(twice.line, 3u);
  EXPECT_THAT(syntax_error(std::string(100000, '[')).what(), HasSubstr("nested deeper than 32"));
  EXPECT_NE(std::string(syntax_error("{\"x\": 1e999}").what()), "no error");
  EXPECT_NE(std::string(syntax_error("{\"x\": NaN}").what()), "no error");
  EXPECT_STREQ(syntax_error("[{\"a\": 1}, {\"a\": 2}]").what(), "no error");
}

TEST(JsonFile, FindsTheLineOfAPointer) {
  const std::string text = R"({
  "a": "tricky , : } \" ] text",
  "b": [
    1,
    {"x/y": [true, null],
     "z~": -1.5e3}
  ],
  "c": {}
})";
  EXPECT_EQ(line_of(text, ""), 1u);
  EXPECT_EQ(line_of(text, "/a"), 2u);
  EXPECT_EQ(line_of(text, "/b"), 3u);
  EXPECT_EQ(line_of(text, "/b/0"), 4u);
  EXPECT_EQ(line_of(text, "/b/1/x~1y/1"), 5u);
  EXPECT_EQ(line_of(text, "/b/1/z~0"), 6u);
  EXPECT_EQ(line_of(text, "/c"), 8u);
  EXPECT_EQ(line_of(text, "/c/missing"), 8u);  // the object that it is missing from
  EXPECT_EQ(line_of(text, "/b/7"), 3u);
}

TEST(JsonFile, ErrorsNameFileLineAndField) {
  const std::string file =
      ::testing::TempDir() + "json_file_test_" + std::to_string(getpid()) + ".json";
  std::ofstream(file) << "{\n  \"mass\": -1,\n  \"colour\": 3\n}\n";
  EXPECT_THAT(
      [&] {
        read_json_file(file, [](JsonReader& in) { in.number("mass", Range::more_than(0, "kg")); });
      },
      ::testing::ThrowsMessage<std::runtime_error>(
          file + ":2: /mass is -1; allowed: more than 0 kg\n" + file +
          ":3: /colour is no field here; allowed: mass"));
  std::ofstream(file) << "{\n  \"mass\" 1\n}\n";
  EXPECT_THAT([&] { read_json_file(file, [](JsonReader&) {}); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr(file + ":2:10: ")));
  EXPECT_THAT([] { read_json_file("no/such.json", [](JsonReader&) {}); },
              ::testing::ThrowsMessage<std::runtime_error>("no/such.json: cannot be opened"));
}

}  // namespace
}  // namespace stagger::sim
