#include "sim/experiment/peers/step_timing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/lipm.h"
#include "engine/reference.h"
#include "engine/step_adjuster.h"
#include "sim/experiment/peers/csv_table.h"

namespace stagger::sim {
namespace {

using engine::Side;
using engine::Vec2;

constexpr double gravity = 9.81;  // [m/s^2]

StepTimingCase read_case(const CsvTable& table, std::size_t row) {
  const auto number = [&](const char* column) { return table.number(row, column); };
  // Written for the left foot standing: the other one steps to y < 0, and the widths count from
  // where the hips put the feet.
  const double hips = number("l_p");
  const double near = -(hips + number("w_min"));
  const double far = -(hips + number("w_max"));
  const std::array<Vec2, 4> corners{Vec2(number("l_min"), far), Vec2(number("l_max"), far),
                                    Vec2(number("l_max"), near), Vec2(number("l_min"), near)};

  const PointWalker walker{std::sqrt(gravity / number("h")), number("t_min"), number("t_max"),
                           engine::ReachRegion(engine::ConvexPolygon(corners))};
  StepTimingCase result{table.text(row, "set"), walker};
  result.stance = number("left_stance") != 0.0 ? Side::left : Side::right;
  result.elapsed = number("t_elapsed");
  result.earliest = std::max(walker.t_min, result.elapsed + number("new_t_min"));
  result.nominal = std::clamp(number("t_nom"), result.earliest, walker.t_max);
  const Vec2 velocity(number("vdes_x"), number("vdes_y"));
  const auto step_from = [&](Side stance) {
    return Vec2(velocity * number("t_nom") - Vec2(0.0, engine::lateral_sign(stance) * hips));
  };
  result.nominal_step = step_from(result.stance);
  result.nominal_offset =
      engine::periodic_dcm_offset(step_from(engine::other(result.stance)), step_from(result.stance),
                                  number("t_nom"), 0.0, walker.omega);
  const Vec2 com(number("com_x"), number("com_y"));
  result.dcm = com + Vec2(number("vel_x"), number("vel_y")) / walker.omega;
  result.qp = {{number("step_x"), number("step_y")}, number("T")};
  for (const char* slack : {"psi0", "psi1", "psi2", "psi3"}) {
    if (number(slack) != 0.0) result.qp_slack = true;
  }
  return result;
}

}  // namespace

std::vector<StepTimingCase> read_step_timing(const std::string& file) {
  const CsvTable table(file);
  std::vector<StepTimingCase> cases;
  for (std::size_t row = 0; row < table.rows(); ++row) cases.push_back(read_case(table, row));
  return cases;
}

StepDecision our_decision(const StepTimingCase& c) {
  engine::StepSituation situation;
  situation.stance.side = c.stance;
  situation.planned = {c.nominal_step, 0.0, engine::other(c.stance)};
  situation.dcm = c.dcm;
  situation.nominal_dcm = c.nominal_step + c.nominal_offset;
  engine::Parameters parameters;
  parameters.step_margin = 0.0;  // for noise, and here is none
  // Points do not get into each other's way.
  parameters.foot_half_length = parameters.foot_half_width = 0.0;
  parameters.foot_clearance = 0.0;
  const double left =
      engine::adjust_time(situation, c.nominal - c.elapsed, c.earliest - c.elapsed,
                          c.walker.t_max - c.elapsed, c.walker.omega, c.walker.reach);
  const engine::StepAdjustment adjustment =
      engine::adjust_step(situation, left, c.walker.omega, c.walker.reach, parameters);
  return {adjustment.step.position, c.elapsed + left};
}

StepDecision our_decision_in_closed_loop(const StepTimingCase& start, double tick) {
  StepTimingCase now = start;
  const double hurry = start.earliest - start.elapsed;
  StepDecision decision = our_decision(now);
  while (decision.touchdown - now.elapsed > hurry + tick) {
    now.dcm = engine::dcm_after(now.dcm, Vec2::Zero(), tick, now.walker.omega);
    now.elapsed += tick;
    decision = our_decision(now);
  }
  return decision;
}

Vec2 offset_after(const StepTimingCase& c, const StepDecision& decision) {
  const double left = decision.touchdown - c.elapsed;
  return engine::dcm_after(c.dcm, Vec2::Zero(), left, c.walker.omega) - decision.step;
}

namespace {

/// Judges decisions for one robot.
class Judge {
 public:
  Judge(const PointWalker& walker, StepTimingComparison& result) : set_(walker), result_(result) {}

  bool catchable(const StepTimingCase& c) const {
    return set_.margin(c.stance, c.dcm, c.earliest - c.elapsed, c.walker.t_max - c.elapsed) >= 0.0;
  }

  /// The simulation decides; the set has to agree.
  bool captured(const StepTimingCase& c, const StepDecision& decision) {
    const Side landed = engine::other(c.stance);
    const Vec2 offset = offset_after(c, decision);
    const bool walking = walks_on(c.walker, landed, offset);
    ++result_.decisions;
    if (walking != (set_.margin(landed, offset) >= 0.0)) ++result_.disagreements;
    return walking;
  }

  bool score(const StepTimingCase& c, const StepDecision& decision, StepTimingScore& score) {
    const bool walking = captured(c, decision);
    if (walking) ++score.captured;
    const double reserve = set_.margin(engine::other(c.stance), offset_after(c, decision));
    const double share = 1.0 / static_cast<double>(result_.cases);
    score.least_reserve = std::min(score.least_reserve, reserve);
    score.mean_reserve += share * reserve;
    score.offset_error_rms =
        std::hypot(score.offset_error_rms, std::sqrt(share) * error(c, decision));
    score.mean_time_change += share * std::abs(decision.touchdown - c.nominal);
    return walking;
  }

  static double error(const StepTimingCase& c, const StepDecision& decision) {
    return (offset_after(c, decision) - c.nominal_offset).norm();
  }

 private:
  CaptureSet set_;
  StepTimingComparison& result_;
};

StepTimingComparison compare_robot(std::span<const StepTimingCase> cases) {
  StepTimingComparison result;
  result.robot = cases[0].robot;
  result.cases = cases.size();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (StepTimingScore* score : {&result.qp, &result.ours, &result.closed_loop}) {
    score->least_reserve = infinity;
  }
  Judge judge(cases[0].walker, result);
  for (const StepTimingCase& c : cases) {
    const StepDecision once = our_decision(c);
    const StepDecision anew = our_decision_in_closed_loop(c, 0.001);
    const bool qp = judge.score(c, c.qp, result.qp);
    const bool ours = judge.score(c, once, result.ours);
    judge.score(c, anew, result.closed_loop);
    if (judge.catchable(c)) ++result.catchable;
    if (c.qp_slack) ++result.qp_slack;
    if (qp && !c.qp_slack) ++result.qp_captured_without_slack;
    if (qp && ours) ++result.both;
    if (qp && ours && !c.qp_slack) ++result.both_without_slack;
    constexpr double worth_telling = 0.001;
    const double nearer = Judge::error(c, c.qp) - Judge::error(c, once);
    if (nearer > worth_telling) ++result.ours_nearer;
    if (nearer < -worth_telling) ++result.qp_nearer;
    result.step_difference = std::max(result.step_difference, (once.step - anew.step).norm());
    result.time_difference =
        std::max(result.time_difference, std::abs(once.touchdown - anew.touchdown));
  }
  for (const double scale : {1.5, 2.0, 3.0, 4.0, 6.0}) {
    StepTimingStress stress{.scale = scale};
    for (StepTimingCase c : cases) {
      c.dcm *= scale;
      if (judge.catchable(c)) ++stress.catchable;
      if (judge.captured(c, our_decision(c))) ++stress.ours;
    }
    result.stress.push_back(stress);
  }
  return result;
}

}  // namespace

std::vector<StepTimingComparison> compare_step_timing(std::span<const StepTimingCase> cases) {
  std::vector<std::vector<StepTimingCase>> robots;
  for (const StepTimingCase& c : cases) {
    auto found = std::find_if(robots.begin(), robots.end(),
                              [&](const auto& robot) { return robot[0].robot == c.robot; });
    if (found == robots.end()) found = robots.emplace(robots.end());
    found->push_back(c);
  }
  std::vector<StepTimingComparison> results;
  results.reserve(robots.size());
  for (const auto& robot : robots) results.push_back(compare_robot(robot));
  return results;
}

}  // namespace stagger::sim
