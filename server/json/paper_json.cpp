#include "server/json/paper_json.h"

#include <cmath>
#include <numbers>

#include "sim/experiment/paper/published.h"

namespace stagger::server {
namespace {

namespace published = sim::published;

/// Whole degrees stay whole.
double degrees(double radians) {
  constexpr double digits = 1e9;
  return std::round(radians * 180.0 / std::numbers::pi * digits) / digits;
}

Json plan_json(const sim::PlanResult& plan) {
  Json nodes = Json::array();
  for (const sim::PlanNode& node : plan.nodes) {
    nodes.push_back({{"t", node.time},
                     {"com_m", node.com},
                     {"dcm_m", node.dcm},
                     {"independent_com_m", node.independent_com}});
  }
  return {
      {"max_velocity_jump", plan.max_velocity_jump}, {"max_node_error", plan.max_node_error},
      {"max_ode_residual", plan.max_ode_residual},   {"start_zmp_offset_m", plan.start_zmp_offset},
      {"start_velocity", plan.start_velocity},       {"nodes", std::move(nodes)}};
}

Json tracking_json(const sim::TrackingResult& tracking) {
  return {{"seeds", tracking.seeds},
          {"noise_std_m", sim::paper_noise},
          {"rms_com_m", tracking.rms_com},
          {"rms_dcm_m", tracking.rms_dcm},
          {"zmp_outside_fraction", tracking.outside},
          {"rms_com_y_m", tracking.rms_com_y},
          {"rms_dcm_y_m", tracking.rms_dcm_y},
          {"zmp_outside_fraction_y", tracking.outside_y}};
}

Json standing_json(const sim::StandingResult& result) {
  return {{"recovered", result.recovered}, {"bound", result.bound}, {"beyond", result.beyond}};
}

Json standing_json(const sim::StandingFigures& figures) {
  Json noise = standing_json(figures.ankle_noise);
  noise["beyond"] = figures.noise_beyond;
  noise["seeds"] = figures.noise_seeds;
  noise["noise_std_m"] = sim::paper_noise;
  Json hips = Json::array();
  for (const sim::StandingResult& result : figures.hips) {
    Json hip{{"torque_nm", result.setup.hip.torque},
             {"inertia", result.setup.hip.inertia},
             {"angle_rad", result.setup.hip.angle}};
    hip.update(standing_json(result));
    hip["largest_angle_rad"] = result.largest_angle;
    hips.push_back(std::move(hip));
  }
  return {{"simulations", figures.ankle.states.size()},
          {"published", {{"simulations", published::standing_simulations}}},
          {"ankle", standing_json(figures.ankle)},
          {"ankle_noise", std::move(noise)},
          {"hip", std::move(hips)}};
}

Json forces_json(const sim::StrategyForces& forces) {
  return {{"ankle_n", forces.ankle}, {"location_n", forces.location}, {"time_n", forces.time}};
}

/// 100 a / b; null where there is nothing to compare with.
Json percent(double a, double b) { return b > 0.0 ? Json(100.0 * a / b) : Json(nullptr); }

/// By how much a is more than b.
Json gain(double a, double b) { return b > 0.0 ? Json(100.0 * (a / b - 1.0)) : Json(nullptr); }

Json limits_json(const sim::SteppingLimits& limits) {
  const sim::StrategyForces& fall = limits.fall;
  Json json{{"t_ss", limits.timing.t_ss},
            {"t_ds", limits.timing.t_ds},
            {"t_left", limits.timing.t_left},
            {"direction_deg", degrees(limits.direction)}};
  json.update(forces_json(fall));
  json["ceiling"] = forces_json(limits.ceiling);
  json["percent"] = {{"ankle", percent(fall.ankle, limits.ceiling.ankle)},
                     {"location", percent(fall.location, limits.ceiling.location)},
                     {"time", percent(fall.time, limits.ceiling.time)}};
  json["gain_percent"] = {{"location", gain(fall.location, fall.ankle)},
                          {"time", gain(fall.time, fall.location)},
                          {"total", gain(fall.time, fall.ankle)}};
  if (limits.noise_seeds > 0) {
    json["noise_median"] = forces_json(limits.noise_median);
    json["noise_least"] = forces_json(limits.noise_least);
    json["noise_greatest"] = forces_json(limits.noise_greatest);
    json["noise_seeds"] = limits.noise_seeds;
  }
  return json;
}

Json limits_json(const std::vector<sim::SteppingLimits>& all) {
  Json list = Json::array();
  for (const sim::SteppingLimits& limits : all) list.push_back(limits_json(limits));
  return list;
}

Json figures_json(const sim::PaperFit& figures) {
  return {{"ankle_n", figures.ankle_n},       {"location_n", figures.location_n},
          {"time_n", figures.time_n},         {"land_350_m", figures.land_350_m},
          {"land_400_m", figures.land_400_m}, {"dt_412_s", figures.dt_412_s},
          {"dt_460_s", figures.dt_460_s}};
}

Json published_json() {
  Json json = figures_json(sim::published_figures);
  json["location_survived_n"] = published::location_survived;
  json["time_survived_n"] = published::time_survived;
  json["gain_percent"] = {{"location", published::location_gain},
                          {"time", published::time_gain},
                          {"total", published::total_gain}};
  return json;
}

Json paper_fit_json(const sim::PaperFit& fit) {
  Json json = figures_json(fit);
  json["gain_percent"] = {{"location", gain(fit.location_n, fit.ankle_n)},
                          {"time", gain(fit.time_n, fit.location_n)},
                          {"total", gain(fit.time_n, fit.ankle_n)}};
  json["worst_deviation_percent"] = 100.0 * sim::worst_deviation(fit);
  return json;
}

std::string_view strategy_name(sim::SteppingStrategy strategy) {
  switch (strategy) {
    case sim::SteppingStrategy::ankle:
      return "ankle";
    case sim::SteppingStrategy::location:
      return "location";
    case sim::SteppingStrategy::time:
      break;
  }
  return "time";
}

Json pushes_json(const std::vector<sim::PushComparison>& pushes) {
  Json list = Json::array();
  for (const sim::PushComparison& push : pushes) {
    list.push_back({{"force_n", push.published.force},
                    {"strategy", strategy_name(push.published.strategy)},
                    {"fell", push.ours.fell},
                    {"land_m", push.ours.landing},
                    {"dt_s", push.ours.time_change},
                    {"published",
                     {{"fell", push.published.fell},
                      {"land_m", or_null(push.published.landing)},
                      {"dt_s", or_null(push.published.time_change)}}}});
  }
  return list;
}

Json stepping_json(const sim::SteppingFigures& figures) {
  Json json{{"stagger", limits_json(figures.limits)}};
  if (!figures.directions.empty()) json["directions"] = limits_json(figures.directions);
  if (figures.paper_fit) json["paper_fit"] = paper_fit_json(*figures.paper_fit);
  if (!figures.pushes.empty()) {
    json["pushes"] = {{"stagger", pushes_json(figures.pushes)},
                      {"paper_fit", pushes_json(figures.fit_pushes)}};
  }
  json["published"] = published_json();
  return json;
}

Json robustness_json(const std::vector<sim::RobustnessResult>& results) {
  Json list = Json::array();
  const std::vector<sim::PushTiming> timings = sim::stepping_timings();
  for (const sim::RobustnessResult& result : results) {
    Json falls = Json::array();
    for (std::size_t i = 0; i < result.fall.size(); ++i) {
      Json fall{
          {"t_ss", timings[i].t_ss}, {"t_ds", timings[i].t_ds}, {"t_left", timings[i].t_left}};
      fall.update(forces_json(result.fall[i]));
      falls.push_back(std::move(fall));
    }
    list.push_back({{"mass", result.error.mass},
                    {"com_height", result.error.com_height},
                    {"delay_s", result.error.delay},
                    {"scenario1",
                     {{"recovered", result.standing_recovered}, {"bound", result.standing_bound}}},
                    {"scenario2", std::move(falls)},
                    {"unpushed_falls", result.unpushed_falls},
                    {"unpushed_runs", result.unpushed_runs}});
  }
  return list;
}

}  // namespace

Json paper_json(const sim::PaperResults& results) {
  Json json = Json::object();
  if (results.plan) json["plan"] = plan_json(*results.plan);
  if (results.tracking) json["lqg"] = tracking_json(*results.tracking);
  if (results.standing) json["scenario1"] = standing_json(*results.standing);
  if (results.stepping) json["scenario2"] = stepping_json(*results.stepping);
  if (!results.robustness.empty()) json["robustness"] = robustness_json(results.robustness);
  json["version"] = STAGGER_VERSION;
  return json;
}

}  // namespace stagger::server
