#include "sim/experiment/paper/stepping.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/reference.h"
#include "sim/experiment/median.h"
#include "sim/experiment/parallel.h"
#include "sim/experiment/push_ceiling.h"

namespace stagger::sim {
namespace {

/// The push comes in the third step: by then the gait has forgotten its start.
constexpr std::uint64_t steps_before_push = 2;
constexpr double watch_s = 5.0;

Vec2 unit(double direction) { return {std::cos(direction), std::sin(direction)}; }

}  // namespace

engine::Strategies strategies_of(SteppingStrategy strategy) {
  return {.ankle = true,
          .hip = false,
          .step = strategy != SteppingStrategy::ankle,
          .time = strategy == SteppingStrategy::time};
}

double& force_of(StrategyForces& forces, SteppingStrategy strategy) {
  switch (strategy) {
    case SteppingStrategy::ankle:
      return forces.ankle;
    case SteppingStrategy::location:
      return forces.location;
    case SteppingStrategy::time:
      break;
  }
  return forces.time;
}

std::vector<PushTiming> stepping_timings() {
  return {{0.8, 0.2, 0.6}, {0.8, 0.2, 0.8}, {1.0, 0.0, 0.8}, {1.0, 0.2, 1.0}, {1.2, 0.2, 1.2}};
}

SteppingSetup stepping_setup(const PushTiming& timing, SteppingStrategy strategy, double noise,
                             std::uint64_t seed, const ModelError& error) {
  SteppingSetup setup;
  setup.parameters = paper_parameters(noise);
  setup.parameters.t_ss = timing.t_ss;
  setup.parameters.t_ds = timing.t_ds;
  setup.parameters.strategies = strategies_of(strategy);
  setup.truth = paper_plant(noise, seed, error);
  setup.t_left = timing.t_left;
  return setup;
}

SteppingOutcome run_stepping(const SteppingSetup& setup, double force, Trace* trace) {
  ClosedLoop loop(setup.parameters, setup.truth);
  const double tick = setup.parameters.tick;
  const int push_ticks = static_cast<int>(std::lround(push_duration / tick));
  const int watch_ticks = static_cast<int>(std::lround(watch_s / tick));
  // By then the push's step is long over, whatever the noise did to the timing.
  const double step = setup.parameters.t_ss + setup.parameters.t_ds;
  const int latest = static_cast<int>((setup.parameters.t_init + 5.0 * step) / tick);

  loop.engine().walk({});
  SteppingOutcome outcome;
  const Vec2 push = force * unit(setup.direction);
  int pushed = -1;
  bool landed = false;
  for (int i = 0; pushed < 0 ? i < latest : i < pushed + watch_ticks; ++i) {
    const engine::WalkingTargets& t = loop.tick([&](const engine::WalkingTargets& targets) -> Vec2 {
      // The nominal time counts, whatever noise has done to the step's.
      const bool due = targets.state == WalkingState::single_support &&
                       targets.step_count == steps_before_push &&
                       setup.parameters.t_ss - targets.phase_time <= setup.t_left + 1e-9;
      if (pushed < 0 && due) {
        pushed = i;
        outcome.push_time = loop.time();
      }
      return pushed >= 0 && i < pushed + push_ticks ? push : Vec2(Vec2::Zero());
    });
    if (trace != nullptr) trace->push_back(loop.sample());
    if (!landed && t.step_count > steps_before_push) {
      landed = true;
      outcome.time_change = t.t_ss - setup.parameters.t_ss;
      const auto& feet = loop.plant().truth().feet;
      outcome.landing = (feet[1].position - feet[0].position).x();
    }
    if (!loop.plant().fall_reason().empty()) {
      outcome.fell = true;
      break;
    }
  }
  // A push that never came would count as one that was survived.
  if (pushed < 0 && !outcome.fell) throw std::logic_error("the gait never came to its push");
  return outcome;
}

double stepping_ceiling(const SteppingSetup& setup, SteppingStrategy strategy) {
  const engine::Parameters& p = setup.parameters;
  const double omega = engine::natural_frequency(p);
  engine::StepAbility ability =
      engine::step_ability(p, engine::ReachRegion(p), strategy == SteppingStrategy::time);
  if (strategy == SteppingStrategy::ankle) ability.reach = {{0.0, -p.stance_width}};

  CeilingPush push;
  push.direction = unit(setup.direction);
  push.duration = push_duration;
  push.t_left = setup.t_left;
  push.mass = setup.truth.mass;
  const Vec2 step(0.0, -p.stance_width);
  push.dcm = engine::periodic_dcm_offset(step, -step, p.t_ss, p.t_ds, omega) *
             std::exp(omega * (p.t_ss - setup.t_left));
  return push_ceiling(ability, push);
}

double first_fall(const SteppingSetup& setup, double ceiling, int rungs) {
  const double top = 1.05 * ceiling;
  double pass = 0.0;
  double fail = top;
  for (int rung = 1; rung <= rungs; ++rung) {
    fail = top * rung / rungs;
    if (run_stepping(setup, fail).fell) break;
    pass = fail;
  }
  constexpr double resolution = 5e-4;  // of the ceiling
  while (fail - pass > resolution * ceiling) {
    const double middle = 0.5 * (pass + fail);
    (run_stepping(setup, middle).fell ? fail : pass) = middle;
  }
  return fail;
}

std::vector<SteppingLimits> stepping_limits(
    const std::vector<std::pair<PushTiming, double>>& conditions, int noise_seeds) {
  struct Search {
    std::size_t condition;
    SteppingStrategy strategy;
    int seed;  ///< 0: no noise
  };
  std::vector<Search> searches;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    for (const SteppingStrategy strategy : stepping_strategies) {
      for (int seed = 0; seed <= noise_seeds; ++seed) searches.push_back({i, strategy, seed});
    }
  }
  struct Found {
    double fall = 0.0;
    double ceiling = 0.0;
  };
  const auto found = parallel_map(searches, [&](const Search& search) {
    const auto& [timing, direction] = conditions[search.condition];
    SteppingSetup setup =
        stepping_setup(timing, search.strategy, search.seed > 0 ? paper_noise : 0.0,
                       static_cast<std::uint64_t>(search.seed));
    setup.direction = direction;
    Found result;
    result.ceiling = stepping_ceiling(setup, search.strategy);
    result.fall = first_fall(setup, result.ceiling, search.seed > 0 ? 21 : 42);
    return result;
  });

  std::vector<SteppingLimits> limits;
  limits.reserve(conditions.size());
  for (const auto& [timing, direction] : conditions) {
    limits.push_back({timing, direction, {}, {}, {}, {}, {}, noise_seeds});
  }
  std::vector<double> noisy;
  for (std::size_t i = 0; i < searches.size(); ++i) {
    const Search& search = searches[i];
    SteppingLimits& limit = limits[search.condition];
    if (search.seed == 0) {
      force_of(limit.fall, search.strategy) = found[i].fall;
      force_of(limit.ceiling, search.strategy) = found[i].ceiling;
      noisy.clear();
    } else {
      noisy.push_back(found[i].fall);
      if (search.seed < noise_seeds) continue;
      const auto [least, greatest] = std::minmax_element(noisy.begin(), noisy.end());
      force_of(limit.noise_least, search.strategy) = *least;
      force_of(limit.noise_greatest, search.strategy) = *greatest;
      force_of(limit.noise_median, search.strategy) = median(noisy);
    }
  }
  return limits;
}

}  // namespace stagger::sim
