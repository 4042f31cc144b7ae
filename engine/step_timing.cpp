#include "engine/step_timing.h"

#include <algorithm>

namespace stagger::engine {
namespace {

/// Steps up to this share of the longest, widest or most turned one keep the nominal durations.
constexpr double comfortable_share = 0.6;

}  // namespace

StepTimes step_times(const WalkCommand& command, const Parameters& parameters) {
  StepTimes times{parameters.t_ss, parameters.t_ds};
  const auto hurry = [&](double speed, double most) {
    const double comfortable = comfortable_share * most;
    if (speed * times.step() > comfortable) {
      times.t_ss = std::clamp(comfortable / speed - times.t_ds,
                              std::min(parameters.least_t_ss, parameters.t_ss), times.t_ss);
    }
  };
  hurry(std::abs(command.vx),
        command.vx < 0.0 ? parameters.max_step_back : parameters.max_step_length);
  // The leading foot takes the way of two steps, on top of the stance width.
  hurry(2.0 * std::abs(command.vy), parameters.max_step_width - parameters.stance_width);
  hurry(std::abs(command.wz), parameters.max_step_turn);
  return times;
}

}  // namespace stagger::engine
