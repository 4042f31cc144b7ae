#include "sim/experiment/paper/paper_fit.h"

#include <algorithm>
#include <cmath>

#include "sim/experiment/median.h"
#include "sim/experiment/parallel.h"

namespace stagger::sim {
namespace {

/// One of the seven figures: a search for the first fall, or what one push did.
struct Question {
  double PaperFit::*figure;
  SteppingStrategy strategy;
  double force;                         ///< 0: the first fall
  double SteppingOutcome::*of_outcome;  ///< unless it is the first fall
};

constexpr std::array<Question, 7> questions{{
    {&PaperFit::ankle_n, SteppingStrategy::ankle, 0.0, nullptr},
    {&PaperFit::location_n, SteppingStrategy::location, 0.0, nullptr},
    {&PaperFit::time_n, SteppingStrategy::time, 0.0, nullptr},
    {&PaperFit::land_350_m, SteppingStrategy::location, 350.0, &SteppingOutcome::landing},
    {&PaperFit::land_400_m, SteppingStrategy::location, 400.0, &SteppingOutcome::landing},
    {&PaperFit::dt_412_s, SteppingStrategy::time, 412.0, &SteppingOutcome::time_change},
    {&PaperFit::dt_460_s, SteppingStrategy::time, 460.0, &SteppingOutcome::time_change},
}};

double answer(const Question& question, const SteppingSetup& setup) {
  if (question.of_outcome != nullptr) {
    return run_stepping(setup, question.force).*question.of_outcome;
  }
  return first_fall(setup, stepping_ceiling(setup, question.strategy));
}

}  // namespace

SteppingSetup paper_fit_setup(SteppingStrategy strategy, double noise, std::uint64_t seed) {
  SteppingSetup setup;
  engine::Parameters& p = setup.parameters;
  // The assumption that makes the published forces possible: half the foot's width, also forward.
  p.foot_half_length = p.foot_half_width;
  // Found by a search over all of these at once for the seven figures: no single one has a meaning.
  p.t_ss = 1.82;
  p.t_ds = 0.042;
  setup.t_left = 1.31;
  p.lqr_state_weight = {1.1, 13.4, 0.0};
  p.lqr_zmp_weight = 1.0;
  p.process_noise = 3.6e-9;
  p.ankle_share = 0.0;  // the paper's step knows nothing of the ankle
  p.step_gain = 0.925;
  // A wider one lets go of the step at its very end, and half a foot does not make that good.
  p.step_margin = 0.03;
  p.step_freeze = 0.004;
  p.time_constant = 0.688;
  p.time_reach = 0.773;
  // The paper's filter: built for its noise, and it knows nothing of pushes.
  p.measurement_noise = paper_noise * paper_noise;
  p.push_gate = 1e9;
  p.strategies = strategies_of(strategy);
  setup.truth = paper_plant(noise, seed);
  return setup;
}

SteppingSetup profile_setup(SteppingProfile profile, SteppingStrategy strategy, double noise,
                            std::uint64_t seed) {
  if (profile == SteppingProfile::paper_fit) return paper_fit_setup(strategy, noise, seed);
  return stepping_setup({0.8, 0.2, 0.6}, strategy, noise, seed);
}

double worst_deviation(const PaperFit& figures) {
  double worst = 0.0;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    worst = std::max(worst, std::abs(figures.values()[i] / published_figures.values()[i] - 1.0));
  }
  return worst;
}

PaperFit run_stepping_figures(
    const std::function<SteppingSetup(SteppingStrategy)>& setup_of_strategy) {
  const std::vector<Question> asked(questions.begin(), questions.end());
  const auto answers = parallel_map(asked, [&](const Question& question) {
    return answer(question, setup_of_strategy(question.strategy));
  });
  PaperFit figures;
  for (std::size_t i = 0; i < questions.size(); ++i) figures.*questions[i].figure = answers[i];
  return figures;
}

PaperFit run_paper_fit() {
  return run_stepping_figures([](SteppingStrategy strategy) { return paper_fit_setup(strategy); });
}

PaperFit run_noisy_paper_fit(int seeds) {
  std::vector<PaperFit> runs;
  for (int seed = 1; seed <= seeds; ++seed) {
    runs.push_back(run_stepping_figures([&](SteppingStrategy strategy) {
      return paper_fit_setup(strategy, paper_noise, static_cast<std::uint64_t>(seed));
    }));
  }
  PaperFit medians;
  for (const Question& question : questions) {
    std::vector<double> values;
    values.reserve(runs.size());
    for (const PaperFit& run : runs) values.push_back(run.*question.figure);
    medians.*question.figure = median(values);
  }
  return medians;
}

std::vector<PushComparison> run_published_pushes(SteppingProfile profile, bool traces) {
  const std::vector<PublishedPush> pushes(published_pushes.begin(), published_pushes.end());
  return parallel_map(pushes, [&](const PublishedPush& push) {
    PushComparison comparison;
    comparison.published = push;
    comparison.ours = run_stepping(profile_setup(profile, push.strategy), push.force,
                                   traces ? &comparison.trace : nullptr);
    return comparison;
  });
}

}  // namespace stagger::sim
