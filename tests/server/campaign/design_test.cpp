#include "server/campaign/design.h"

#include <functional>
#include <map>
#include <set>

#include "tests/server/campaign/campaign_fixture.h"

namespace stagger::server::campaign {
namespace {

/// Answers by level, and remembers what it was asked to run.
class KnownSurvival final : public Known {
 public:
  KnownSurvival(const Design& design, std::function<Verdict(double)> of)
      : design_(design), of_(std::move(of)) {}

  std::uint64_t count() const override { return run_.size(); }
  std::optional<Verdict> verdict(std::uint64_t number) const override {
    if (!run_.contains(number)) return std::nullopt;
    return of_(design_.level(design_.place(number).level));
  }
  /// Runs until the design wants no more; the number of rounds.
  int run() {
    for (int rounds = 0;; ++rounds) {
      const Round round = design_.next_round(*this);
      if (round.empty()) return rounds;
      for (std::uint64_t i = 0; i < round.size(); ++i) {
        EXPECT_TRUE(run_.insert(round[i]).second) << "wanted again: " << round[i];
      }
    }
  }

 private:
  const Design& design_;
  std::function<Verdict(double)> of_;
  std::set<std::uint64_t> run_;
};

class DesignTest : public CampaignFixture {
 protected:
  static Verdict below(double level, double limit) {
    return level < limit ? Verdict::pass : Verdict::fail;
  }
};

TEST_F(DesignTest, GridIsEveryCombinationWithItsRepeats) {
  const auto plan = plan_of(grid());
  const Design& design = plan->design();
  EXPECT_EQ(design.numbers(), 12U);
  std::set<std::string> all;
  for (std::uint64_t number = 0; number < 12; ++number) {
    const Place place = design.place(number);
    EXPECT_EQ(design.number(place), number);
    std::string text = std::to_string(place.repeat);
    for (const auto& [path, value] : design.settings(place)) text += " " + path + value.dump();
    all.insert(text);
  }
  EXPECT_EQ(all.size(), 12U);
}

TEST_F(DesignTest, ListGoesWithTheFactors) {
  auto spec = grid();
  spec["design"] = nlohmann::json::parse(R"({"kind":"list","trials":[
      {"name":"weak","set":{"push.impulse_ns":1}}, {"name":"strong","set":{"push.impulse_ns":9}}]})");
  spec["factors"].erase("push.impulse_ns");
  const auto plan = plan_of(spec);
  EXPECT_EQ(plan->design().numbers(), 4U);
  const auto settings = plan->design().settings(plan->design().place(2));
  ASSERT_EQ(settings.size(), 3U);
  EXPECT_EQ(settings[0], Setting("name", "strong"));
  EXPECT_EQ(settings[1], Setting("push.impulse_ns", 9));
  EXPECT_EQ(settings[2], Setting("push.direction_deg", 0));
}

TEST_F(DesignTest, RandomDrawsEachFactorForItself) {
  auto spec = grid();
  spec["design"] = {{"kind", "random"}, {"samples", 1000}};
  spec["factors"] = {{"push.impulse_ns", {{"uniform", {2, 4}}}}};
  const auto one = plan_of(spec);
  spec["factors"]["push.direction_deg"] = {0, 90, 180};
  const auto two = plan_of(spec);
  double sum = 0.0;
  std::map<double, int> directions;
  for (std::uint64_t cell = 0; cell < 1000; ++cell) {
    const auto settings = two->design().settings({cell, 0, 0});
    EXPECT_EQ(settings.back(), one->design().settings({cell, 0, 0}).back());
    const auto impulse = settings.back().second.get<double>();
    EXPECT_TRUE(impulse >= 2.0 && impulse < 4.0);
    sum += impulse;
    ++directions[settings.front().second.get<double>()];
  }
  // Of a mean with standard deviation 2 / sqrt(12) / sqrt(1000) = 0.018.
  EXPECT_NEAR(sum / 1000.0, 3.0, 0.08);
  ASSERT_EQ(directions.size(), 3U);
  for (const auto& [direction, count] : directions) EXPECT_NEAR(count, 333, 75) << direction;
}

TEST_F(DesignTest, BisectionFindsEveryLimitWithinItsBound) {
  const auto plan = plan_of(bisection(1.0));
  const Design& design = plan->design();
  for (double limit = 2.5; limit < 35.0; limit += 1.0) {
    KnownSurvival survival(design, [&](double level) { return below(level, limit); });
    survival.run();
    EXPECT_LE(survival.count(), design.most_trials());
    const Limit found = design.limit(1, survival);
    ASSERT_TRUE(found.done && found.monotone && !found.undecided);
    EXPECT_EQ(design.level(*found.pass), limit - 0.5);
    if (limit > 34.0) {
      EXPECT_FALSE(found.fail);
    } else {
      EXPECT_EQ(design.level(*found.fail), limit + 0.5);
    }
    EXPECT_EQ(found.trials * design.cells(), survival.count());
  }
}

TEST_F(DesignTest, BisectionKnowsNothingBelowALowestLevelThatFails) {
  const auto plan = plan_of(bisection(1.0));
  KnownSurvival survival(plan->design(), [](double) { return Verdict::fail; });
  EXPECT_EQ(survival.run(), 1);
  const Limit found = plan->design().limit(0, survival);
  EXPECT_TRUE(found.done);
  EXPECT_FALSE(found.pass);
  EXPECT_EQ(plan->design().level(*found.fail), 2.0);
}

TEST_F(DesignTest, BisectionFlagsSurvivalThatIsNotMonotone) {
  const auto plan = plan_of(bisection(1.0));
  KnownSurvival survival(plan->design(), [](double level) {
    return level < 12.0 || (level > 25.0 && level < 27.0) ? Verdict::pass : Verdict::fail;
  });
  survival.run();
  const Limit found = plan->design().limit(0, survival);
  EXPECT_FALSE(found.monotone);
  EXPECT_EQ(plan->design().level(*found.pass), 11.0);
  EXPECT_EQ(plan->design().level(*found.fail), 12.0);
  EXPECT_EQ(plan->design().level(*found.highest_pass), 26.0);
}

TEST_F(DesignTest, BisectionTakesATrialThatSaysNothingForNoFall) {
  const auto plan = plan_of(bisection(1.0));
  KnownSurvival survival(plan->design(), [](double level) {
    return level > 20.0 ? Verdict::undecided : Verdict::pass;
  });
  survival.run();
  const Limit found = plan->design().limit(0, survival);
  EXPECT_TRUE(found.undecided);
  EXPECT_FALSE(found.fail);
}

TEST_F(DesignTest, LastLevelIsTheGreatest) {
  const auto plan = plan_of(bisection(5.0));  // 2, 7, ..., 32, and 34
  EXPECT_EQ(plan->design().level(6), 32.0);
  EXPECT_EQ(plan->design().level(7), 34.0);
}

TEST(Round, SharesMakeTheWhole) {
  for (const Round& round : {Round::range(11), Round::list({3, 5, 6, 9, 20})}) {
    std::set<std::uint64_t> all;
    std::uint64_t size = 0;
    for (std::uint64_t part = 0; part < 4; ++part) {
      const Round share = round.share(part, 4);
      size += share.size();
      for (std::uint64_t i = 0; i < share.size(); ++i) all.insert(share[i]);
    }
    EXPECT_EQ(size, round.size());
    EXPECT_EQ(all.size(), round.size());
    for (std::uint64_t i = 0; i < round.size(); ++i) EXPECT_TRUE(all.contains(round[i]));
  }
  EXPECT_TRUE(Round::list({1}).share(2, 3).empty());
}

}  // namespace
}  // namespace stagger::server::campaign
