#include "server/json/terrain_json.h"

#include <gmock/gmock.h>

#include "sim/json_file.h"

namespace stagger::server {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// "pointer text" of all that is wrong.
std::vector<std::string> terrain_errors(const std::string& text) {
  sim::JsonErrors errors;
  parse_terrain(text, errors);
  std::vector<std::string> all;
  for (const sim::JsonError& error : errors.list()) all.push_back(error.pointer + " " + error.text);
  return all;
}

Json resolved(const std::string& text) {
  sim::JsonErrors errors;
  const Json json = terrain_json(parse_terrain(text, errors));
  EXPECT_TRUE(errors.empty()) << text;
  return json;
}

TEST(TerrainJson, EveryKindReadsBackTheSame) {
  for (const char* text :
       {R"({"kind":"flat"})", R"({"kind":"slope","angle_deg":5,"uphill_deg":-90,"friction":0.5})",
        R"({"kind":"uneven","height_m":0.02,
            "patches":[{"x_min":-1,"x_max":2,"y_min":0,"y_max":0.5,"friction":0.1}]})",
        R"({"kind":"platform","vx":0.1,"shoves":[{"at_s":2,"x_m":0.1},
            {"at_s":4,"y_m":-0.2,"duration_s":0.5}]})"}) {
    const Json once = resolved(text);
    const Json twice = resolved(once.dump());
    EXPECT_EQ(once["kind"], twice["kind"]);
    sim::JsonErrors errors;
    const auto first = parse_terrain(text, errors);
    const auto second = parse_terrain(once.dump(), errors);
    EXPECT_NEAR(first.slope_angle, second.slope_angle, 1e-15);
    EXPECT_NEAR(first.uphill_angle, second.uphill_angle, 1e-15);
    EXPECT_EQ(first.unevenness, second.unevenness);
    EXPECT_EQ(first.friction, second.friction);
    ASSERT_EQ(first.patches.size(), second.patches.size());
    for (std::size_t i = 0; i < first.patches.size(); ++i) {
      EXPECT_EQ(first.patches[i].low, second.patches[i].low);
      EXPECT_EQ(first.patches[i].high, second.patches[i].high);
      EXPECT_EQ(first.patches[i].friction, second.patches[i].friction);
    }
    EXPECT_EQ(first.platform_velocity, second.platform_velocity);
    ASSERT_EQ(first.shoves.size(), second.shoves.size());
    for (std::size_t i = 0; i < first.shoves.size(); ++i) {
      EXPECT_EQ(first.shoves[i].at_s, second.shoves[i].at_s);
      EXPECT_EQ(first.shoves[i].duration_s, second.shoves[i].duration_s);
      EXPECT_EQ(first.shoves[i].displacement, second.shoves[i].displacement);
    }
  }
}

TEST(TerrainJson, TheShortFormsOfTheCommandLine) {
  EXPECT_EQ(resolved("flat")["kind"], "flat");
  EXPECT_EQ(resolved("uneven:0.02"), resolved(R"({"kind":"uneven","height_m":0.02})"));
  EXPECT_EQ(resolved("slope:5"), resolved(R"({"kind":"slope","angle_deg":5})"));
  EXPECT_EQ(resolved("slope:5:180"),
            resolved(R"({"kind":"slope","angle_deg":5,"uphill_deg":180})"));
  EXPECT_THAT(terrain_errors("hills"), ::testing::SizeIs(1));
  EXPECT_THAT(terrain_errors("slope"), ::testing::SizeIs(1));
  EXPECT_THAT(terrain_errors("uneven:0.02:1"), ::testing::SizeIs(1));
  EXPECT_THAT(terrain_errors("flat:1"), ::testing::SizeIs(1));
  EXPECT_THROW(terrain_errors("slope:steep"), sim::JsonSyntaxError);
}

TEST(TerrainJson, WhatIsOutOfRangeIsNamedWithWhatIsAllowed) {
  EXPECT_THAT(terrain_errors("slope:8.1"),
              ElementsAre("/angle_deg is 8.1; allowed: 0 to 8 degrees"));
  EXPECT_THAT(terrain_errors("uneven:0.04"),
              ElementsAre("/height_m is 0.04; allowed: 0 to 0.03 m"));
  EXPECT_THAT(terrain_errors(R"({"kind":"flat","friction":0.9})"),
              ElementsAre("/friction is 0.9; allowed: 0.1 to 0.8"));
  EXPECT_THAT(terrain_errors(R"({"kind":"flat","friction":0.1})"), IsEmpty());
  EXPECT_THAT(terrain_errors(R"({"kind":"platform","vx":0.4,"vy":0.4})"), ::testing::SizeIs(1));
  EXPECT_THAT(
      terrain_errors(
          R"({"kind":"flat","patches":[{"x_min":1,"x_max":0,"y_min":0,"y_max":1,"friction":1}]})"),
      ElementsAre("/patches/0/x_max is 0; allowed: 1 to 1000 m",
                  "/patches/0/friction is 1; allowed: 0.1 to 0.8"));
  // A field of another kind is unknown here.
  EXPECT_THAT(terrain_errors(R"({"kind":"flat","angle_deg":3})"), ::testing::SizeIs(1));
}

}  // namespace
}  // namespace stagger::server
