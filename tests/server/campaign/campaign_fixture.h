// What the tests of campaigns share: plans from JSON, stores in a folder of their own, and trials
// that cost nothing.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "server/campaign/campaign.h"

namespace stagger::server::campaign {

class CampaignFixture : public ::testing::Test {
 protected:
  CampaignFixture() {
    static int count = 0;
    folder = std::filesystem::temp_directory_path() /
             ("stagger-" + std::to_string(getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(folder);
  }
  ~CampaignFixture() override { std::filesystem::remove_all(folder); }

  /// A grid of three pushes of the pendulum in two directions.
  static nlohmann::json grid() {
    return nlohmann::json::parse(R"({
      "version": 1, "name": "grid", "seed": 5,
      "base": {"robot": "kasaei", "plant": "lipm", "settle_s": 1, "observe_s": 1,
               "push": {"duration_s": 0.05}},
      "design": {"kind": "grid", "repeats": 2},
      "factors": {"push.direction_deg": [0, 90], "push.impulse_ns": {"linspace": [2, 6, 3]}}})");
  }
  static nlohmann::json bisection(double tol) {
    nlohmann::json spec = grid();
    spec["design"] = {{"kind", "bisect"}, {"axis", "push.impulse_ns"},
                      {"lo", 2},          {"hi", 34},
                      {"tol", tol},       {"repeats", 2},
                      {"scan", 5}};
    spec["factors"] = {{"push.direction_deg", {0, 90}}};
    return spec;
  }

  /// The specification has to be right.
  std::unique_ptr<Plan> plan_of(const nlohmann::json& body) {
    sim::JsonErrors errors;
    CampaignSpec spec = read_campaign(body, errors);
    for (const auto& error : errors.list()) ADD_FAILURE() << error.pointer << ' ' << error.text;
    return std::make_unique<Plan>(std::move(spec), library);
  }

  Store store_of(const std::string& name, const std::string& specification = "{}") {
    const auto file = folder / name;
    Store::create(file, specification);
    return {file, Store::Access::write};
  }

  /// Falls from a push of `limit` on [N s], and depends on its seed a little.
  static sim::TrialResult made_up(const sim::TrialSpec& spec, double limit) {
    sim::TrialResult result;
    result.delivered_ns = spec.push->impulse_ns;
    result.outcome =
        spec.push->impulse_ns < limit ? sim::TrialOutcome::recovered : sim::TrialOutcome::fell;
    if (result.outcome == sim::TrialOutcome::recovered) {
      result.steps_to_recover = spec.seed % 4;
      result.recovery_time_s = 0.5;
    } else {
      result.fall_time_s = 2.0;
      result.reason = "fell";
    }
    result.ticks = 2000;
    result.state_hash = spec.seed * 3 + static_cast<std::uint64_t>(spec.push->impulse_ns * 1000);
    return result;
  }
  static CampaignOptions options_of(double limit, unsigned threads = 2) {
    CampaignOptions options;
    options.runner.threads = threads;
    options.runner.trial = [limit](const sim::TrialSpec& spec) { return made_up(spec, limit); };
    return options;
  }

  std::filesystem::path folder;
  RobotLibrary library{"robots"};
};

}  // namespace stagger::server::campaign
