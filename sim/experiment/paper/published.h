// The numbers that the paper prints, for comparison. It gives no gait timing with its forces.
#pragma once

namespace stagger::sim::published {

/// Scenario 1: initial states tried.
inline constexpr int standing_simulations = 441;

/// Scenario 2, push of 10 ms forward. What falls first under the ankle alone; the caption of the
/// paper's figure has 326 [N].
inline constexpr double ankle_fall = 325.0;
/// With the place of the step adjusted: greatest force survived, and the one drawn falling [N].
inline constexpr double location_survived = 411.0;
inline constexpr double location_fall = 412.0;
/// With place and time adjusted, likewise [N].
inline constexpr double time_survived = 530.0;
inline constexpr double time_fall = 532.0;
/// Landing of the step at 350 and 400 N [m].
inline constexpr double landing_at_350 = 0.71;
inline constexpr double landing_at_400 = 0.92;
/// Change of single support at 412 and 460 N [s].
inline constexpr double time_change_at_412 = -0.12;
inline constexpr double time_change_at_460 = -0.15;
/// Gains: place over ankle, time over place, both over ankle [%].
inline constexpr double location_gain = 26.0;
inline constexpr double time_gain = 29.0;
inline constexpr double total_gain = 63.0;

}  // namespace stagger::sim::published
