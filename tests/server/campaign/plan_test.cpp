#include "server/campaign/plan.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "server/campaign/plan_check.h"
#include "tests/server/campaign/campaign_fixture.h"

namespace stagger::server::campaign {
namespace {

using ::testing::HasSubstr;

class PlanTest : public CampaignFixture {
 protected:
  std::vector<sim::JsonError> errors_of(const nlohmann::json& body) {
    sim::JsonErrors errors;
    CampaignSpec spec = read_campaign(body, errors);
    if (errors.empty()) check_plan(Plan(std::move(spec), library), errors);
    return errors.list();
  }
};

TEST_F(PlanTest, TrialsDifferInSeedAndId) {
  const auto plan = plan_of(grid());
  std::set<std::string> ids;
  std::set<std::uint64_t> seeds;
  for (std::uint64_t number = 0; number < plan->design().numbers(); ++number) {
    const PlannedTrial trial = plan->trial(number);
    EXPECT_EQ(trial.refused, "");
    EXPECT_LT(trial.spec.seed, std::uint64_t{1} << 53);
    ids.insert(trial.id);
    seeds.insert(trial.spec.seed);
  }
  EXPECT_EQ(ids.size(), 12U);
  EXPECT_EQ(seeds.size(), 12U);
}

TEST_F(PlanTest, TheSameTrialIsTheSameAnywhere) {
  const auto one = plan_of(grid())->trial(7);
  const auto two = plan_of(grid())->trial(7);
  EXPECT_EQ(one.id, two.id);
  EXPECT_EQ(one.resolved, two.resolved);
  auto other = grid();
  other["seed"] = 6;
  EXPECT_NE(one.id, plan_of(other)->trial(7).id);
}

TEST_F(PlanTest, OneInAHundredIsRunTwiceAndTheFirstIs) {
  auto spec = grid();
  spec["design"]["repeats"] = 500;
  const auto plan = plan_of(spec);
  int twice = 0;
  for (std::uint64_t number = 0; number < 3000; ++number) twice += plan->trial(number).twice;
  EXPECT_TRUE(plan->trial(0).twice);
  EXPECT_NEAR(twice, 30, 20);
}

TEST_F(PlanTest, PushesAreScaledToTheRobot) {
  auto spec = grid();
  spec["factors"] = {{"push.fr", {0.1}}, {"robot", {"kasaei", "op3"}}};
  spec["design"]["repeats"] = 1;
  const auto plan = plan_of(spec);
  for (const std::uint64_t number : {0, 1}) {
    const PlannedTrial trial = plan->trial(number);
    ASSERT_EQ(trial.refused, "");
    const double h = trial.robot->description.walk.com_height_m;
    EXPECT_NEAR(trial.push.fr, 0.1, 1e-12);
    EXPECT_NEAR(trial.push.delta_v, 0.1 * std::sqrt(9.81 * h), 1e-12);
    EXPECT_NEAR(trial.push.impulse_ns, trial.push.delta_v * trial.robot->model.mass(), 1e-12);
    EXPECT_NEAR(trial.push.force_n, trial.push.impulse_ns / 0.05, 1e-9);
  }
  spec["factors"] = {{"push.delta_v", {0.5}}};
  EXPECT_NEAR(plan_of(spec)->trial(0).push.impulse_ns, 15.0, 1e-9);
}

TEST_F(PlanTest, OfSeveralPushesTheHardestCounts) {
  auto spec = grid();
  spec["base"].erase("push");
  spec["base"]["pushes"] = {{{"delta_v", 0.1}}, {{"delta_v", 0.3}, {"at_s", 20}}};
  spec["factors"] = {{"pushes.0.delta_v", {0.2, 0.5}}};
  spec["design"]["repeats"] = 1;
  const auto plan = plan_of(spec);
  EXPECT_NEAR(plan->trial(0).push.delta_v, 0.3, 1e-12);
  EXPECT_NEAR(plan->trial(1).push.delta_v, 0.5, 1e-12);
  // Settling, watching, both pushes, and the second one's time and patience: 32.2 s.
  spec["limits"] = {{"trial_timeout_s", 32.3}};
  EXPECT_TRUE(errors_of(spec).empty());
  spec["limits"] = {{"trial_timeout_s", 32.1}};
  EXPECT_FALSE(errors_of(spec).empty());
  spec["limits"].clear();
  spec["base"]["pushes"][1]["link"] = "tail";
  ASSERT_FALSE(errors_of(spec).empty());
  EXPECT_EQ(errors_of(spec).front().pointer, "/base/pushes/1/link");
}

TEST_F(PlanTest, ParametersAreNamedWithTheirDots) {
  auto spec = grid();
  spec["factors"]["parameters.gait.t_ss"] = {0.4, 0.5};
  const auto plan = plan_of(spec);
  EXPECT_EQ(plan->trial(0).resolved["parameters"]["gait.t_ss"], 0.4);
  EXPECT_EQ(plan->trial(23).resolved["parameters"]["gait.t_ss"], 0.5);
  spec["factors"]["parameters.gait.t_ss"] = {0.4, -1};
  ASSERT_FALSE(errors_of(spec).empty());
  EXPECT_EQ(errors_of(spec).front().pointer, "/factors/parameters.gait.t_ss/1");
}

TEST_F(PlanTest, ErrorsPointToWhereTheFieldIsSet) {
  struct Case {
    std::string pointer;
    std::string text;
    std::function<void(nlohmann::json&)> spoil;
  };
  const std::vector<Case> cases{
      {"/base/plant", "mujoco", [](auto& s) { s["base"]["plant"] = "mujoco"; }},
      {"/base/robot", "kasaei", [](auto& s) { s["base"]["robot"] = "nobody"; }},
      {"/base/push/link", "torso", [](auto& s) { s["base"]["push"]["link"] = "tail"; }},
      {"/base/colour", "no field", [](auto& s) { s["base"]["colour"] = "red"; }},
      {"/base/seed", "a factor", [](auto& s) { s["base"]["seed"] = 1; }},
      {"/factors/push.direction_deg/1", "400",
       [](auto& s) {
         s["factors"]["push.direction_deg"] = {0, 400};
       }},
      {"/factors/push.direction_deg/0", "400",
       [](auto& s) {
         s["factors"]["push.direction_deg"] = {400, 0};
       }},
      {"/factors/push.impulse_ns", "-2",
       [](auto& s) {
         s["factors"]["push.impulse_ns"] = {{"linspace", {2, -6, 3}}};
       }},
      {"/factors/robot.name", "no such part", [](auto& s) { s["factors"]["robot.name"] = {1}; }},
      {"/factors/push.delta_v", "together",
       [](auto& s) {
         s["factors"]["push.delta_v"] = {1, 2};
       }},
      {"/design", "max_trials", [](auto& s) { s["design"]["repeats"] = 100'000; }},
      {"/base", "trial_timeout_s",
       [](auto& s) {
         s["limits"] = {{"trial_timeout_s", 1}};
       }},
      {"/design", "makes trial",
       [](auto& s) {
         // Each value can be, not all of them together.
         s["factors"]["stand"] = {false, true};
         s["factors"]["walk.vx"] = {0.0, 0.1};
       }},
      {"/thresholds/0", "asks for push.knee",
       [](auto& s) { s["thresholds"] = {"falls == 0 where push.knee == 1"}; }},
  };
  ASSERT_TRUE(errors_of(grid()).empty());
  for (const Case& wrong : cases) {
    auto spec = grid();
    wrong.spoil(spec);
    const auto errors = errors_of(spec);
    ASSERT_FALSE(errors.empty()) << wrong.pointer;
    EXPECT_THAT(errors.front().pointer, HasSubstr(wrong.pointer)) << errors.front().text;
    EXPECT_THAT(errors.front().text, HasSubstr(wrong.text)) << wrong.pointer;
  }
}

TEST_F(PlanTest, ATrialThatCannotBeTellsWhy) {
  auto spec = grid();
  spec["factors"]["push.direction_deg"] = {0, 400};
  const PlannedTrial trial = plan_of(spec)->trial(6);
  EXPECT_THAT(trial.refused, HasSubstr("/push/direction_deg is 400"));
}

}  // namespace
}  // namespace stagger::server::campaign
