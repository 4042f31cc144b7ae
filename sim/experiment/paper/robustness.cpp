#include "sim/experiment/paper/robustness.h"

#include "sim/experiment/paper/standing.h"
#include "sim/experiment/parallel.h"

namespace stagger::sim {
namespace {

struct Run {
  ModelError error;
  PushTiming timing;
  SteppingStrategy strategy = SteppingStrategy::ankle;
};

struct Outcome {
  double fall = 0.0;  ///< [N]
  int unpushed_falls = 0;
};

constexpr std::array<double, 2> noises{0.0, paper_noise};

Outcome search(const Run& run) {
  Outcome outcome;
  const SteppingSetup setup = stepping_setup(run.timing, run.strategy, 0.0, 1, run.error);
  outcome.fall = first_fall(setup, stepping_ceiling(setup, run.strategy), 21);
  for (const double noise : noises) {
    const SteppingSetup unpushed = stepping_setup(run.timing, run.strategy, noise, 1, run.error);
    if (run_stepping(unpushed, 0.0).fell) ++outcome.unpushed_falls;
  }
  return outcome;
}

}  // namespace

std::vector<RobustnessResult> run_robustness() {
  const std::vector<ModelError> errors{{1.0, 1.0, 0.0},  {0.9, 1.0, 0.0}, {1.1, 1.0, 0.0},
                                       {1.0, 0.9, 0.0},  {1.0, 1.1, 0.0}, {1.0, 1.0, 0.02},
                                       {0.9, 0.9, 0.02}, {1.1, 1.1, 0.02}};
  const std::vector<PushTiming> timings = stepping_timings();
  std::vector<Run> runs;
  for (const ModelError& error : errors) {
    for (const PushTiming& timing : timings) {
      for (const SteppingStrategy strategy : stepping_strategies) {
        runs.push_back({error, timing, strategy});
      }
    }
  }
  const std::vector<Outcome> outcomes = parallel_map(runs, search);

  std::vector<RobustnessResult> results;
  auto outcome = outcomes.begin();
  for (const ModelError& error : errors) {
    RobustnessResult result;
    result.error = error;
    StandingSetup standing;
    standing.error = error;
    const StandingResult stood = run_standing(standing);
    result.standing_recovered = stood.recovered;
    result.standing_bound = stood.bound;
    for (std::size_t i = 0; i < timings.size(); ++i) {
      StrategyForces forces;
      for (const SteppingStrategy strategy : stepping_strategies) {
        force_of(forces, strategy) = outcome->fall;
        result.unpushed_falls += outcome->unpushed_falls;
        result.unpushed_runs += static_cast<int>(noises.size());
        ++outcome;
      }
      result.fall.push_back(forces);
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace stagger::sim
