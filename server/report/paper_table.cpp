#include "server/report/paper_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "server/report/scale.h"
#include "sim/experiment/paper/published.h"

namespace stagger::server {
namespace {

namespace published = sim::published;

std::string newtons(double force) { return fixed(force, 0); }
std::string share(double part, double whole) {
  return whole > 0.0 ? fixed(100.0 * part / whole, 1) + " %" : "";
}

PaperRow row_of(std::string name, std::string unit) {
  PaperRow row;
  row.name = std::move(name);
  row.unit = std::move(unit);
  return row;
}

PaperGroup plan_group(const sim::PlanResult& plan) {
  const auto row = [](const char* name, const char* unit, double value) {
    PaperRow r = row_of(name, unit);
    r.ours = significant(value, 2);
    return r;
  };
  return {"Planner: six diagonal steps of 0.5 m",
          {row("Jump of CoM velocity between phases, greatest", "m/s", plan.max_velocity_jump),
           row("CoM at the phases' ends, off an independent solution", "m", plan.max_node_error),
           row("CoM and DCM, off a numerical integration", "m", plan.max_ode_residual)}};
}

PaperGroup tracking_group(const sim::TrackingResult& tracking) {
  const auto row = [](const char* name, const char* unit, double value) {
    PaperRow r = row_of(name, unit);
    r.noise = fixed(value, 2);
    return r;
  };
  constexpr double mm = 1e3;
  constexpr double percent = 100.0;
  return {"LQG: six steps forward, " + std::to_string(tracking.seeds) + " seeds of noise",
          {row("CoM error, RMS, sagittal", "mm", mm * tracking.rms_com),
           row("CoM error, RMS, lateral", "mm", mm * tracking.rms_com_y),
           row("DCM error, RMS, sagittal", "mm", mm * tracking.rms_dcm),
           row("DCM error, RMS, lateral", "mm", mm * tracking.rms_dcm_y),
           row("Ticks with the ZMP at the front or rear edge", "%", percent * tracking.outside),
           row("Ticks with the ZMP at a side edge", "%", percent * tracking.outside_y)}};
}

PaperGroup standing_group(const sim::StandingFigures& figures) {
  PaperGroup group;
  group.title = "Scenario 1: states brought to rest on one foot, of " +
                std::to_string(figures.ankle.states.size()) +
                " (published: " + std::to_string(published::standing_simulations) +
                " simulations, no count)";
  const auto row = [&](std::string name, const sim::StandingResult& result) {
    PaperRow r = row_of(std::move(name), "states");
    r.ours = std::to_string(result.recovered);
    r.ceiling = std::to_string(result.bound);
    r.percent = share(result.recovered, result.bound);
    return r;
  };
  group.rows.push_back(row("Ankle", figures.ankle));
  group.rows.back().noise = std::to_string(figures.ankle_noise.recovered);
  for (const sim::StandingResult& result : figures.hips) {
    group.rows.push_back(row("Ankle and hip: " + fixed(result.setup.hip.torque, 0) + " N m, " +
                                 fixed(result.setup.hip.inertia, 1) + " kg m², " +
                                 fixed(result.setup.hip.angle, 1) + " rad",
                             result));
  }
  return group;
}

PaperGroup stepping_group(const sim::SteppingLimits& limits) {
  const auto seconds = [](double s) { return coordinate(s, 3) + " s"; };
  PaperGroup group;
  group.title = "Scenario 2: first fall, push of 10 ms " + direction_text(limits.direction) +
                "; single support " + seconds(limits.timing.t_ss) + ", double " +
                seconds(limits.timing.t_ds) + ", " + seconds(limits.timing.t_left) +
                " left at the push";
  const bool forward = std::abs(limits.direction) < 1e-9;
  const auto row = [&](const char* name, double sim::StrategyForces::*member, std::string printed) {
    PaperRow r = row_of(name, "N");
    r.ours = newtons(limits.fall.*member);
    if (limits.noise_seeds > 0) r.noise = newtons(limits.noise_median.*member);
    if (forward) r.published = std::move(printed);
    r.ceiling = newtons(limits.ceiling.*member);
    r.percent = share(limits.fall.*member, limits.ceiling.*member);
    return r;
  };
  group.rows = {
      row("Ankle", &sim::StrategyForces::ankle, newtons(sim::published_figures.ankle_n)),
      row("Ankle and place of the step", &sim::StrategyForces::location,
          newtons(published::location_survived) + "\u2013" +
              newtons(sim::published_figures.location_n)),
      row("Ankle, place and time of the step", &sim::StrategyForces::time,
          newtons(published::time_survived) + "\u2013" + newtons(sim::published_figures.time_n))};
  return group;
}

PaperGroup paper_fit_group(const sim::PaperFit& fit) {
  const sim::PaperFit& printed = sim::published_figures;
  const auto row = [](const char* name, const char* unit, double ours, double theirs,
                      int decimals) {
    PaperRow r = row_of(name, unit);
    r.ours = fixed(ours, decimals);
    r.published = fixed(theirs, decimals);
    return r;
  };
  return {"Scenario 2 by settings fitted to the published numbers",
          {row("First fall, ankle", "N", fit.ankle_n, printed.ankle_n, 0),
           row("First fall, ankle and place", "N", fit.location_n, printed.location_n, 0),
           row("First fall, ankle, place and time", "N", fit.time_n, printed.time_n, 0),
           row("Landing at 350 N, place", "m", fit.land_350_m, printed.land_350_m, 2),
           row("Landing at 400 N, place", "m", fit.land_400_m, printed.land_400_m, 2),
           row("Change of single support at 412 N", "s", fit.dt_412_s, printed.dt_412_s, 2),
           row("Change of single support at 460 N", "s", fit.dt_460_s, printed.dt_460_s, 2)}};
}

PaperGroup robustness_group(const std::vector<sim::RobustnessResult>& results) {
  PaperGroup group;
  group.title = "The engine wrong about its robot: first fall, of that without error, least of all";
  for (const sim::RobustnessResult& result : results) {
    if (&result == &results.front()) continue;
    PaperRow row = row_of("True robot: " + error_text(result.error), "%");
    double least = std::numeric_limits<double>::infinity();
    for (const auto strategy : {&sim::StrategyForces::ankle, &sim::StrategyForces::location,
                                &sim::StrategyForces::time}) {
      least = std::min(least, least_share(result, results.front(), strategy));
    }
    row.ours = fixed(100.0 * least, 0);
    group.rows.push_back(std::move(row));
  }
  return group;
}

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

}  // namespace

std::vector<PaperGroup> paper_table(const sim::PaperResults& results) {
  std::vector<PaperGroup> groups;
  if (results.plan) groups.push_back(plan_group(*results.plan));
  if (results.tracking) groups.push_back(tracking_group(*results.tracking));
  if (results.standing) groups.push_back(standing_group(*results.standing));
  if (results.stepping) {
    for (const sim::SteppingLimits& limits : results.stepping->limits) {
      groups.push_back(stepping_group(limits));
    }
    if (results.stepping->paper_fit)
      groups.push_back(paper_fit_group(*results.stepping->paper_fit));
  }
  if (!results.robustness.empty()) groups.push_back(robustness_group(results.robustness));
  return groups;
}

std::string to_columns(const std::vector<PaperGroup>& groups) {
  constexpr std::size_t count = 7;
  const auto cells = [](const PaperRow& row) {
    return std::array<std::string, count>{"  " + row.name, row.unit,    row.ours,   row.noise,
                                          row.published,   row.ceiling, row.percent};
  };
  const std::array<std::string, count> heads{"",          "unit",    "ours",      "noisy",
                                             "published", "ceiling", "of ceiling"};
  std::array<std::size_t, count> widths{};
  for (std::size_t i = 0; i < count; ++i) widths[i] = characters(heads[i]);
  for (const PaperGroup& group : groups) {
    for (const PaperRow& row : group.rows) {
      const auto texts = cells(row);
      for (std::size_t i = 0; i < count; ++i) {
        widths[i] = std::max(widths[i], characters(texts[i]));
      }
    }
  }
  std::string out;
  const auto line = [&](const std::array<std::string, count>& texts) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
      const std::string blanks(widths[i] - characters(texts[i]), ' ');
      if (i > 0) text += "  ";
      text += i < 2 ? texts[i] + blanks : blanks + texts[i];
    }
    text.erase(text.find_last_not_of(' ') + 1);
    out += text + "\n";
  };
  line(heads);
  for (const PaperGroup& group : groups) {
    out += "\n" + group.title + "\n";
    for (const PaperRow& row : group.rows) line(cells(row));
  }
  return out;
}

std::string timing_text(const sim::PushTiming& timing) {
  return coordinate(timing.t_ss, 3) + " / " + coordinate(timing.t_ds, 3) + " / " +
         coordinate(timing.t_left, 3);
}

std::string error_text(const sim::ModelError& error) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  const auto percent = [](double factor) {
    return std::string(factor > 1.0 ? " +" : " \u2212") + fixed(100.0 * std::abs(factor - 1.0), 0) +
           " %";
  };
  if (error.mass != 1.0) add("mass" + percent(error.mass));
  if (error.com_height != 1.0) add("CoM height" + percent(error.com_height));
  if (error.delay > 0.0) add("delay " + fixed(1e3 * error.delay, 0) + " ms");
  return text.empty() ? "no error" : text;
}

double least_share(const sim::RobustnessResult& result, const sim::RobustnessResult& without,
                   double sim::StrategyForces::*strategy) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(result.fall.size(), without.fall.size()); ++i) {
    if (!(without.fall[i].*strategy > 0.0)) continue;
    least = std::min(least, result.fall[i].*strategy / (without.fall[i].*strategy));
  }
  return least;
}

std::string direction_text(double direction) {
  const double degrees = direction * 180.0 / std::numbers::pi;
  const double off = std::abs(std::remainder(degrees, 360.0));
  if (off < 1e-6) return "forward";
  if (off > 180.0 - 1e-6) return "backward";
  return coordinate(off, 1) + "° to the " +
         (std::remainder(degrees, 360.0) > 0.0 ? "left" : "right");
}

}  // namespace stagger::server
