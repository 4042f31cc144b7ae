#include "sim/experiment/paper/tracking.h"

#include <cmath>
#include <stdexcept>

#include "sim/experiment/parallel.h"

namespace stagger::sim {
namespace {

constexpr std::size_t steps_tracked = 6;
constexpr double tracked_step_length = 0.5;
constexpr double still_s = 1.0;
constexpr double after_s = 1.5;

struct TrackedWalk {
  Vec2 com_squares = Vec2::Zero();
  Vec2 dcm_squares = Vec2::Zero();
  Vec2 outside = Vec2::Zero();
  double ticks = 0.0;
  Trace trace;
};

TrackedWalk track(std::uint64_t seed) {
  engine::Parameters p = paper_parameters(paper_noise);
  p.t_ss = 1.0;
  p.t_ds = 0.0;
  p.process_noise = 1e-7;  // a walk without pushes: the filter may be slower
  p.strategies = {.ankle = true, .hip = false, .step = false, .time = false};
  ClosedLoop loop(p, paper_plant(paper_noise, seed));
  std::vector<engine::Footstep> steps;
  Side side = Side::right;
  for (std::size_t i = 1; i <= steps_tracked; ++i) {
    const double y = 0.5 * p.stance_width * engine::lateral_sign(side);
    steps.push_back({Vec2(tracked_step_length * static_cast<double>(i), y), 0.0, side});
    side = engine::other(side);
  }

  TrackedWalk run;
  const auto tick = [&] {
    const engine::WalkingTargets& t = loop.tick();
    const TraceSample& s = loop.sample();
    run.com_squares += s.com.error().cwiseAbs2();
    run.dcm_squares += s.dcm.error().cwiseAbs2();
    // The command lies on an edge when what was wanted lies beyond it.
    const engine::ConvexPolygon& polygon = loop.engine().support_polygon();
    Vec2 held = Vec2::Zero();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      constexpr double rounding = 1e-9;
      const Vec2& normal = polygon.normal(i);
      if (polygon.offset(i) - normal.dot(t.zmp_command) > rounding) continue;
      held[std::abs(normal.x()) > std::abs(normal.y()) ? 0 : 1] = 1.0;
    }
    run.outside += held;
    run.ticks += 1.0;
    run.trace.push_back(s);
    return t.state;
  };
  while (loop.time() < still_s) tick();
  if (loop.engine().follow(steps) != engine::WalkingEngine::StepListError::none) {
    throw std::logic_error("the six steps of the paper are out of reach");
  }
  const double latest = loop.time() + 2.0 * p.t_init + steps_tracked * (p.t_ss + p.t_ds) + 1.0;
  while (tick() != WalkingState::idle && loop.time() < latest) {
  }
  const double stood = loop.time();
  while (loop.time() < stood + after_s) tick();
  return run;
}

}  // namespace

TrackingResult run_tracking(int seeds) {
  std::vector<std::uint64_t> all;
  for (int seed = 1; seed <= seeds; ++seed) all.push_back(static_cast<std::uint64_t>(seed));
  std::vector<TrackedWalk> runs = parallel_map(all, track);

  TrackedWalk sum;
  for (const TrackedWalk& run : runs) {
    sum.com_squares += run.com_squares;
    sum.dcm_squares += run.dcm_squares;
    sum.outside += run.outside;
    sum.ticks += run.ticks;
  }
  TrackingResult result;
  result.seeds = seeds;
  result.rms_com = std::sqrt(sum.com_squares.x() / sum.ticks);
  result.rms_dcm = std::sqrt(sum.dcm_squares.x() / sum.ticks);
  result.rms_com_y = std::sqrt(sum.com_squares.y() / sum.ticks);
  result.rms_dcm_y = std::sqrt(sum.dcm_squares.y() / sum.ticks);
  result.outside = sum.outside.x() / sum.ticks;
  result.outside_y = sum.outside.y() / sum.ticks;
  result.trace = std::move(runs.front().trace);
  return result;
}

}  // namespace stagger::sim
