// Pushes that others have published, to be set beside ours: at equal Fr = delta_v / sqrt(g h).
#pragma once

#include <array>
#include <string_view>

namespace stagger::server {

/// Where a push goes, in terms of the foot that stands.
enum class PushSide : unsigned char { forward, diagonal, outward, back, inward };

struct PublishedPush {
  std::string_view who;
  PushSide side;
  double delta_v;  ///< [m/s]
  double fr;
  std::string_view conditions;
};

// IHMC's are what its regression tests demand, a lower bound on what Atlas can take; h 1.1 m.
inline constexpr std::string_view atlas_conditions =
    "simulated, walking 0.3 m steps of 0.6 s + 0.25 s, at the chest, 50 ms, noisy sensors";
inline constexpr std::string_view atlas_name = "IHMC Atlas, threshold of its regression tests";
inline constexpr std::array<PublishedPush, 7> published_pushes{{
    {atlas_name, PushSide::forward, 0.8, 0.245, atlas_conditions},
    {atlas_name, PushSide::back, 0.8, 0.245, atlas_conditions},
    {atlas_name, PushSide::diagonal, 0.8, 0.245, atlas_conditions},
    {atlas_name, PushSide::outward, 0.6, 0.18, atlas_conditions},
    {atlas_name, PushSide::inward, 0.3, 0.09, atlas_conditions},
    {"Digit, best of three controllers", PushSide::back, 0.57, 0.19,
     "the real robot, stepping in place, hit from the front, 26.4 N s"},
    {"Kasaei et al. 2019", PushSide::forward, 0.177, 0.056,
     "pendulum model, stepping in place, 530 N for 10 ms, 30 kg, h 1 m"},
}};

}  // namespace stagger::server
