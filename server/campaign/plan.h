// A campaign's specification with its robots: every trial number becomes a trial.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/campaign/design.h"
#include "server/campaign/spec.h"
#include "server/json/json.h"
#include "server/robot_library.h"
#include "sim/experiment/trial.h"

namespace stagger::server::campaign {

/// How hard a trial pushes. With several pushes: of the hardest.
struct PushFigures {
  double impulse_ns = 0.0;
  double force_n = 0.0;  ///< mean over the push [N]
  double delta_v = 0.0;  ///< impulse over mass [m/s]
  double fr = 0.0;       ///< delta_v / sqrt(g h), h the height of the CoM while walking
};

/// One of these by its path, "push.impulse_ns", "push.delta_v", "push.fr"; nothing for another.
std::optional<double> push_figure(std::string_view path, const PushFigures& figures);

/// One trial, ready to be run.
struct PlannedTrial {
  std::uint64_t number = 0;
  std::string id;  ///< hash over the resolved trial, its seed among it, and the version
  std::uint64_t repeat = 0;
  Json values;         ///< what the campaign sets: {"push.direction_deg":15,...}
  Json resolved;       ///< the whole specification, for `stagger trial`; null when refused
  bool twice = false;  ///< it is run twice, to see whether it repeats to the bit
  sim::TrialSpec spec;
  std::shared_ptr<const sim::Robot> robot;
  PushFigures push;
  std::string refused;  ///< why it cannot be run; empty when it can
};

class Plan {
 public:
  /// Takes the robots that the specification names out of the library.
  Plan(CampaignSpec spec, RobotLibrary& library);
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  const CampaignSpec& spec() const { return spec_; }
  const Design& design() const { return design_; }
  /// Safe to call from many threads.
  PlannedTrial trial(std::uint64_t number) const;
  /// The trial as JSON before it is read: base, settings, seed. Adds to `errors` what is wrong with
  /// the settings and with how hard its pushes are.
  nlohmann::json assembled(const std::vector<Setting>& settings, std::uint64_t number,
                           sim::JsonErrors& errors) const;
  /// Reads an assembled trial; its errors point into it.
  sim::TrialSpec read(const nlohmann::json& assembled, sim::JsonErrors& errors) const;
  /// nullptr when there is no such robot.
  std::shared_ptr<const sim::Robot> robot(const std::string& name) const;

 private:
  void take_robot(const nlohmann::json& name, RobotLibrary& library);

  CampaignSpec spec_;
  Design design_;
  std::map<std::string, std::shared_ptr<const sim::Robot>> robots_;
  std::string known_robots_;
};

}  // namespace stagger::server::campaign
