// Numbers that the paper prints, beside those of published_figures in paper_fit.h. It gives no gait
// timing with its forces.
#pragma once

namespace stagger::sim::published {

/// Scenario 1: initial states tried.
inline constexpr int standing_simulations = 441;

/// Scenario 2, push of 10 ms forward: greatest force survived with the place of the step adjusted,
/// and with place and time [N].
inline constexpr double location_survived = 411.0;
inline constexpr double time_survived = 530.0;
/// Gains: place over ankle, time over place, both over ankle [%].
inline constexpr double location_gain = 26.0;
inline constexpr double time_gain = 29.0;
inline constexpr double total_gain = 63.0;

}  // namespace stagger::sim::published
