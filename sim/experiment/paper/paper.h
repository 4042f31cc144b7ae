// The whole paper in one call: what was asked for, and everything that came out of it.
#pragma once

#include <optional>

#include "sim/experiment/paper/paper_fit.h"
#include "sim/experiment/paper/plan.h"
#include "sim/experiment/paper/robustness.h"
#include "sim/experiment/paper/standing.h"
#include "sim/experiment/paper/stepping.h"
#include "sim/experiment/paper/tracking.h"

namespace stagger::sim {

struct PaperRequest {
  bool plan = true;
  bool tracking = true;
  bool standing = true;
  bool stepping = true;
  bool robustness = true;
  int seeds = 20;          ///< of tracking, and of the push limits under noise; at least 1
  int standing_seeds = 5;  ///< of standing under noise; at least 1
  /// Stepping: this timing and direction [rad] alone, instead of the five timings and all around.
  std::optional<PushTiming> timing;
  double direction = 0.0;
};

/// One of the 441 states as it goes on in time.
struct StandingExample {
  double position = 0.0;  ///< [m]
  double velocity = 0.0;  ///< [m/s]
  Trace trace;
};

struct StandingFigures {
  StandingResult ankle;
  StandingResult ankle_noise;  ///< the seed that brings fewest states to rest
  int noise_seeds = 0;
  int noise_beyond = 0;  ///< states recovered beyond the bound, over all seeds
  std::vector<StandingResult> hips;
  StandingExample recovered;
  StandingExample lost;
};

struct SteppingFigures {
  std::vector<SteppingLimits> limits;  ///< forward, or what was asked for
  // Not for a timing that was asked for:
  std::vector<SteppingLimits> directions;  ///< the other seven directions, without noise
  std::optional<PaperFit> paper_fit;
  std::vector<PushComparison> pushes;      ///< of the paper's figures, our own settings
  std::vector<PushComparison> fit_pushes;  ///< the same by the fit
};

struct PaperResults {
  std::optional<PlanResult> plan;
  std::optional<TrackingResult> tracking;
  std::optional<StandingFigures> standing;
  std::optional<SteppingFigures> stepping;
  std::vector<RobustnessResult> robustness;  ///< empty when not asked for
};

/// Takes all cores; the result depends on the request alone.
PaperResults run_paper(const PaperRequest& request);

/// Flywheels from the weakest to the strongest.
std::vector<engine::HipParameters> standing_hips();

}  // namespace stagger::sim
