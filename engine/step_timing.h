// How long a step takes: the durations that belong to a commanded velocity.
#pragma once

#include "engine/parameters.h"

namespace stagger::engine {

struct StepTimes {
  double t_ss = 0.0;  ///< single support [s]
  double t_ds = 0.0;  ///< double support [s]
  double step() const { return t_ss + t_ds; }
};

/// The parameters' durations as long as the steps stay comfortably short, forwards, sideways and in
/// their turn; a faster walk takes quicker steps, down to least_t_ss, before it takes longer ones.
/// Double support keeps its duration. The command has to be finite.
StepTimes step_times(const WalkCommand& command, const Parameters& parameters);

}  // namespace stagger::engine
