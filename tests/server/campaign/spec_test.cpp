#include "server/campaign/spec.h"

#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "server/campaign/plan_check.h"
#include "tests/server/campaign/campaign_fixture.h"

namespace stagger::server::campaign {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json file(const std::string& name) {
  std::ifstream in(name);
  EXPECT_TRUE(in) << name;
  return json::parse(in);
}

/// docs/campaign.schema.json, by a library that knows nothing of the reader.
class Schema {
 public:
  Schema() {
    const json text = file("docs/campaign.schema.json");
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(valijson::adapters::NlohmannJsonAdapter(text), schema_);
  }
  bool takes(const json& value) {
    return valijson::Validator().validate(schema_, valijson::adapters::NlohmannJsonAdapter(value),
                                          nullptr);
  }

 private:
  valijson::Schema schema_;
};

std::vector<sim::JsonError> errors_of(const json& body) {
  sim::JsonErrors errors;
  read_campaign(body, errors);
  return errors.list();
}

class SpecTest : public CampaignFixture {};

TEST_F(SpecTest, SchemaAndReaderRefuseTheSame) {
  struct Case {
    std::string pointer;
    std::function<void(json&)> spoil;
  };
  const std::vector<Case> cases{
      {"/version", [](json& s) { s["version"] = 2; }},
      {"/version", [](json& s) { s.erase("version"); }},
      {"/name", [](json& s) { s["name"] = "../up"; }},
      {"/name", [](json& s) { s["name"] = ""; }},
      {"/name", [](json& s) { s.erase("name"); }},
      {"/seed", [](json& s) { s["seed"] = -1; }},
      {"/seed", [](json& s) { s["seed"] = 1.5; }},
      {"/colour", [](json& s) { s["colour"] = "red"; }},
      {"/base", [](json& s) { s.erase("base"); }},
      {"/base", [](json& s) { s["base"] = 3; }},
      {"/base/seed", [](json& s) { s["base"]["seed"] = 3; }},
      {"/design", [](json& s) { s.erase("design"); }},
      {"/design/kind", [](json& s) { s["design"]["kind"] = "latin"; }},
      {"/design/repeats", [](json& s) { s["design"]["repeats"] = 0; }},
      {"/design/samples", [](json& s) { s["design"]["samples"] = 3; }},
      {"/design/samples", [](json& s) { s["design"]["kind"] = "random"; }},
      {"/design/trials", [](json& s) { s["design"]["kind"] = "list"; }},
      {"/design/axis", [](json& s) { s["design"]["kind"] = "bisect"; }},
      {"/design/trials",
       [](json& s) {
         s["design"] = {{"kind", "list"}, {"trials", json::array()}};
       }},
      {"/design/trials/0/set",
       [](json& s) {
         s["design"] = {{"kind", "list"}, {"trials", {{{"name", "a"}}}}};
       }},
      {"/factors/push..x", [](json& s) { s["factors"]["push..x"] = {1}; }},
      {"/factors/a", [](json& s) { s["factors"]["a"] = 3; }},
      {"/factors/a", [](json& s) { s["factors"]["a"] = json::array(); }},
      {"/factors/a", [](json& s) { s["factors"]["a"] = json::object(); }},
      {"/factors/a/linspace",
       [](json& s) {
         s["factors"]["a"] = {{"linspace", {1, 2}}};
       }},
      {"/factors/a/steps",
       [](json& s) {
         s["factors"]["a"] = {{"linspace", {1, 2, 3}}, {"steps", 3}};
       }},
      {"/thresholds/0", [](json& s) { s["thresholds"] = {3}; }},
      {"/thresholds/0/expr",
       [](json& s) {
         s["thresholds"] = {{{"abort", true}}};
       }},
      {"/pass/recover_within_s", [](json& s) { s["pass"]["recover_within_s"] = 61; }},
      {"/limits/max_trials", [](json& s) { s["limits"]["max_trials"] = 0; }},
      {"/limits/retries", [](json& s) { s["limits"]["retries"] = 1; }},
  };
  Schema schema;
  ASSERT_TRUE(errors_of(grid()).empty());
  ASSERT_TRUE(schema.takes(grid()));
  ASSERT_TRUE(errors_of(bisection(1.0)).empty());
  ASSERT_TRUE(schema.takes(bisection(1.0)));
  for (const Case& wrong : cases) {
    json spec = grid();
    wrong.spoil(spec);
    EXPECT_FALSE(schema.takes(spec)) << wrong.pointer << ' ' << spec;
    bool told = false;
    for (const auto& error : errors_of(spec)) told = told || error.pointer == wrong.pointer;
    EXPECT_TRUE(told) << wrong.pointer << ' ' << spec;
  }
}

TEST_F(SpecTest, ReaderRefusesWhatNoSchemaTells) {
  struct Case {
    std::string pointer;
    std::string text;
    std::function<void(json&)> spoil;
  };
  const std::vector<Case> cases{
      {"/factors/a/uniform", "random",
       [](json& s) {
         s["factors"]["a"] = {{"uniform", {1, 2}}};
       }},
      {"/factors/a/range", "1 to 10000",
       [](json& s) {
         s["factors"]["a"] = {{"range", {1, 2, -1}}};
       }},
      {"/factors/a/range", "1 to 10000",
       [](json& s) {
         s["factors"]["a"] = {{"range", {1, 2, 0}}};
       }},
      {"/factors/a/linspace", "2 to 10000",
       [](json& s) {
         s["factors"]["a"] = {{"linspace", {1, 2, 1}}};
       }},
      {"/thresholds/0", "fall_rate", [](json& s) { s["thresholds"] = {"rate == 0"}; }},
      {"/thresholds/0", "bisect", [](json& s) { s["thresholds"] = {"min(limit_ns) > 1"}; }},
      {"/factors", "at least one",
       [](json& s) {
         s["design"] = {{"kind", "random"}, {"samples", 3}};
         s.erase("factors");
       }},
      {"/design/hi", "more than",
       [](json& s) {
         s = bisection(1.0);
         s["design"]["hi"] = 2;
       }},
      {"/design/tol", "10000",
       [](json& s) {
         s = bisection(1.0);
         s["design"]["tol"] = 1e-6;
       }},
      {"/factors/push.impulse_ns", "axis",
       [](json& s) {
         s = bisection(1.0);
         s["factors"]["push.impulse_ns"] = {3};
       }},
      {"/design/trials/1/name", "again",
       [](json& s) {
         const json entry{{"name", "a"}, {"set", json::object()}};
         s["design"] = {{"kind", "list"}, {"trials", {entry, entry}}};
       }},
  };
  for (const Case& wrong : cases) {
    json spec = grid();
    wrong.spoil(spec);
    const auto errors = errors_of(spec);
    ASSERT_FALSE(errors.empty()) << wrong.pointer;
    EXPECT_EQ(errors.front().pointer, wrong.pointer);
    EXPECT_THAT(errors.front().text, HasSubstr(wrong.text));
  }
}

TEST_F(SpecTest, ValuesAreMadeAsDecimalsAreWritten) {
  json spec = grid();
  spec["factors"] = {{"a", {{"range", {0.1, 0.5, 0.1}}}},
                     {"b", {{"linspace", {0, 345, 24}}}},
                     {"c", {{"logspace", {1, 100, 3}}}}};
  sim::JsonErrors errors;
  const CampaignSpec read = read_campaign(spec, errors);
  ASSERT_TRUE(errors.empty());
  EXPECT_EQ(read.factors[0].values, (std::vector<json>{0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(read.factors[1].values[1], 15.0);
  EXPECT_EQ(read.factors[1].values.size(), 24U);
  EXPECT_EQ(read.factors[2].values, (std::vector<json>{1.0, 10.0, 100.0}));
}

TEST_F(SpecTest, ShippedCampaignsAreRight) {
  Schema schema;
  for (const char* name : {"smoke", "omni", "ihmc-like", "ablation"}) {
    const json body = file("tests/campaigns/" + std::string(name) + ".json");
    EXPECT_TRUE(schema.takes(body)) << name;
    const auto plan = plan_of(body);
    sim::JsonErrors errors;
    check_plan(*plan, errors);
    for (const auto& error : errors.list()) {
      ADD_FAILURE() << name << ' ' << error.pointer << ' ' << error.text;
    }
    EXPECT_EQ(plan->spec().name, name);
  }
}

}  // namespace
}  // namespace stagger::server::campaign
