#include "engine/step_timing.h"

#include <algorithm>

namespace stagger::engine {
namespace {

/// Steps up to this share of the longest one keep the nominal durations.
constexpr double comfortable_share = 0.6;

}  // namespace

StepTimes step_times(const WalkCommand& command, const Parameters& parameters) {
  StepTimes times{parameters.t_ss, parameters.t_ds};
  const double speed = std::abs(command.vx);
  const double comfortable = comfortable_share * parameters.max_step_length;
  if (speed * times.step() > comfortable) {
    times.t_ss = std::clamp(comfortable / speed - times.t_ds,
                            std::min(parameters.least_t_ss, parameters.t_ss), parameters.t_ss);
  }
  return times;
}

}  // namespace stagger::engine
