#include "sim/strict_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace stagger::sim {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// "pointer text" of every error.
std::vector<std::string> errors_of(const json& value, const JsonReader::Fields& fields) {
  JsonErrors errors;
  read_json(value, errors, fields);
  std::vector<std::string> result;
  for (const JsonError& error : errors.list()) result.push_back(error.pointer + " " + error.text);
  return result;
}

TEST(StrictJson, ReadsEveryKindOfField) {
  const json value = {{"mass", 2.5},
                      {"count", 3},
                      {"whole", 4.0},
                      {"on", true},
                      {"name", "torso"},
                      {"mode", "b"},
                      {"point", {1, 2.5, 3}},
                      {"inner", {{"x", 1}}},
                      {"pose", {{"knee", 0.5}, {"hip", -0.5}}},
                      {"list", {1, 2}},
                      {"words", {"u", "v"}},
                      {"items", json::array({{{"x", 1}}, {{"x", 2}}})}};
  double inner = 0.0;
  std::vector<double> items;
  EXPECT_THAT(
      errors_of(value,
                [&](JsonReader& in) {
                  EXPECT_EQ(in.number("mass"), 2.5);
                  EXPECT_EQ(in.integer("count"), 3);
                  EXPECT_EQ(in.integer("whole"), 4);
                  EXPECT_TRUE(in.boolean("on"));
                  EXPECT_EQ(in.string("name"), "torso");
                  EXPECT_EQ(in.one_of("mode", Names<int>{{"a", 10}, {"b", 20}}), 20);
                  EXPECT_EQ(in.vec3("point"), engine::Vec3(1.0, 2.5, 3.0));
                  in.object("inner", [&](JsonReader& nested) { inner = nested.number("x"); });
                  EXPECT_THAT(in.numbers("pose"),
                              ElementsAre(std::pair("hip", -0.5), std::pair("knee", 0.5)));
                  EXPECT_THAT(in.number_list("list", Range::any(), Range::between(1, 5)),
                              ElementsAre(1.0, 2.0));
                  EXPECT_THAT(in.string_list("words", Range::between(1, 5)), ElementsAre("u", "v"));
                  in.object_list("items", Range::between(1, 5),
                                 [&](JsonReader& item) { items.push_back(item.number("x")); });
                }),
      IsEmpty());
  EXPECT_EQ(inner, 1.0);
  EXPECT_THAT(items, ElementsAre(1.0, 2.0));
}

TEST(StrictJson, WhatIsNotGivenReadsAsItsDefault) {
  EXPECT_THAT(errors_of(json::object(),
                        [](JsonReader& in) {
                          EXPECT_FALSE(in.has("a"));
                          EXPECT_EQ(in.number_or("a", 1.5), 1.5);
                          EXPECT_EQ(in.integer_or("b", 2), 2);
                          EXPECT_TRUE(in.boolean_or("c", true));
                          EXPECT_EQ(in.string_or("d", "x"), "x");
                          EXPECT_EQ(in.one_of_or("e", 7, Names<int>{{"a", 1}}), 7);
                          EXPECT_EQ(in.vec3_or("f", engine::Vec3::UnitX()), engine::Vec3::UnitX());
                          EXPECT_EQ(in.optional_number("g"), std::nullopt);
                          EXPECT_EQ(in.optional_integer("h"), std::nullopt);
                          EXPECT_EQ(in.optional_boolean("i"), std::nullopt);
                          EXPECT_EQ(in.optional_string("j"), std::nullopt);
                          EXPECT_EQ(in.optional_vec3("k"), std::nullopt);
                          EXPECT_FALSE(in.optional_one_of("l", Names<int>{{"a", 1}}).has_value());
                          EXPECT_FALSE(in.optional_object("m", [](JsonReader&) { FAIL(); }));
                        }),
              IsEmpty());
}

TEST(StrictJson, TellsEverythingThatIsWrongAtOnce) {
  const json value = {{"impulse_ns", -3},
                      {"duration_s", "long"},
                      {"seed", 1.5},
                      {"profile", "triangular"},
                      {"point", {1, 2}},
                      {"loud", true},
                      {"trigger", {{"at_s", -1}, {"when", 2}}}};
  const auto errors = errors_of(value, [](JsonReader& in) {
    in.string("link");
    in.number("impulse_ns", Range::more_than_up_to(0.0, 200.0, "N s"));
    in.number("duration_s", Range::between(0.001, 5.0, "s"));
    in.integer("seed", Range::at_least(0.0));
    in.one_of("profile", Names<int>{{"rectangular", 0}, {"half_sine", 1}});
    in.vec3("point", Range::between(-2.0, 2.0, "m"));
    in.object("trigger",
              [](JsonReader& trigger) { trigger.number("at_s", Range::at_least(0, "s")); });
  });
  EXPECT_THAT(
      errors,
      ElementsAre("/link is missing; required: a string of 1 to 256 bytes",
                  "/impulse_ns is -3; allowed: more than 0 to 200 N s",
                  "/duration_s is \"long\"; allowed: a number, 0.001 to 5 s",
                  "/seed is 1.5; allowed: a whole number, 0 to 9.00719925474e+15",
                  "/profile is \"triangular\"; allowed: rectangular, half_sine",
                  "/point is the array [1,2]; allowed: an array of three numbers, -2 to 2 m",
                  "/trigger/at_s is -1; allowed: at least 0 s",
                  "/trigger/when is no field here; allowed: at_s",
                  "/loud is no field here; allowed: duration_s, impulse_ns, link, point, "
                  "profile, seed, trigger"));
}

TEST(StrictJson, WrongOptionalFieldsAreErrorsToo) {
  EXPECT_THAT(errors_of({{"a", "x"}, {"b", nullptr}, {"c", 1}, {"d", 3}},
                        [](JsonReader& in) {
                          EXPECT_EQ(in.number_or("a", 4.0), 4.0);
                          EXPECT_EQ(in.optional_string("b"), std::nullopt);
                          EXPECT_TRUE(in.boolean_or("c", true));
                          EXPECT_FALSE(in.optional_object("d", [](JsonReader&) { FAIL(); }));
                        }),
              ElementsAre("/a is \"x\"; allowed: a number",
                          "/b is null; allowed: a string of 1 to 256 bytes",
                          "/c is 1; allowed: true, false", "/d is 3; allowed: an object"));
}

TEST(StrictJson, LimitsAreExact) {
  const auto accepts = [](const Range& range, double value) {
    return errors_of({{"x", value}}, [&](JsonReader& in) { in.number("x", range); }).empty();
  };
  EXPECT_TRUE(accepts(Range::between(0, 1), 0.0));
  EXPECT_TRUE(accepts(Range::between(0, 1), 1.0));
  EXPECT_FALSE(accepts(Range::between(0, 1), 1.0000001));
  EXPECT_FALSE(accepts(Range::more_than_up_to(0, 1), 0.0));
  EXPECT_TRUE(accepts(Range::from_to_below(0, 1), 0.0));
  EXPECT_FALSE(accepts(Range::from_to_below(0, 1), 1.0));
  EXPECT_FALSE(accepts(Range::more_than(2), 2.0));
  EXPECT_TRUE(accepts(Range::at_least(2), 2.0));
}

TEST(StrictJson, NotANumberNeverPasses) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    const json value = {{"x", bad}, {"v", {0.0, bad, 0.0}}, {"l", {bad}}, {"n", {{"a", bad}}}};
    const auto errors = errors_of(value, [](JsonReader& in) {
      in.number("x");
      in.vec3("v");
      in.number_list("l", Range::any(), Range::at_least(0));
      in.numbers("n");
    });
    EXPECT_EQ(errors.size(), 4u);
  }
}

TEST(StrictJson, IntegersBeyondTheDoublesAreRefused) {
  EXPECT_THAT(
      errors_of({{"seed", 18446744073709551615ULL}}, [](JsonReader& in) { in.integer("seed"); }),
      ElementsAre(HasSubstr("/seed is 18446744073709551615; allowed: a whole number")));
}

TEST(StrictJson, PointersAreEscaped) {
  EXPECT_THAT(errors_of({{"a/b~c", 1}}, [](JsonReader&) {}),
              ElementsAre(HasSubstr("/a~1b~0c is no field here")));
}

TEST(StrictJson, ListsNameTheElement) {
  EXPECT_THAT(
      errors_of({{"l", {1, "x"}}, {"o", json::array({{{"x", 1}}, 5})}, {"e", json::array()}},
                [](JsonReader& in) {
                  in.number_list("l", Range::any("N s"), Range::between(1, 9));
                  in.object_list("o", Range::between(1, 9),
                                 [](JsonReader& item) { item.number("x"); });
                  in.string_list("e", Range::between(1, 9));
                }),
      ElementsAre("/l/1 is \"x\"; allowed: a number, in N s", "/o/1 is 5; allowed: an object",
                  "/e is the array []; allowed: an array of strings, length 1 to 9"));
}

TEST(StrictJson, TheRootMustBeAnObject) {
  EXPECT_THAT(errors_of(json::array({1}), [](JsonReader&) { FAIL(); }),
              ElementsAre(" is the array [1]; allowed: an object"));
}

TEST(StrictJson, HostileDocumentsMakeShortAnswers) {
  json value = {{"text", std::string(100000, 'x') + "\xff"}};
  for (int i = 0; i < 5000; ++i) value["unknown" + std::to_string(i)] = i;
  const auto errors = errors_of(value, [](JsonReader& in) { in.number("text"); });
  EXPECT_EQ(errors.size(), 100u);
  EXPECT_LT(errors[0].size(), 200u);
}

}  // namespace
}  // namespace stagger::sim
