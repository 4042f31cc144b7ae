// Our controller beside four others on the same walk of a point mass with the same two kicks, all
// footsteps fixed: how far ZMP and CoM stray from the reference.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/parameters.h"

namespace stagger::sim {

/// The walk: six steps of 0.8 s between double supports of 0.2 s, CoM at 1 m. Each kick changes the
/// velocity on both axes.
inline constexpr double walk_first_swing = 2.1;                   ///< [s]
inline constexpr std::array<double, 2> walk_kicks{4.505, 8.505};  ///< [s]
inline constexpr double walk_kick = 0.05;                         ///< [m/s]

/// What one controller did: one entry a tick, the ZMP held over that tick.
struct Trajectory {
  std::string name;
  double tick = 0.0;  ///< [s]
  std::vector<engine::Vec2> com{};
  std::vector<engine::Vec2> dcm{};
  std::vector<engine::Vec2> zmp{};
  std::vector<engine::Vec2> zmp_reference{};
  bool band = false;  ///< the controller knows no reference but only limits: it is their middle
};

/// Throws std::runtime_error when the file cannot be read. Named after the file.
Trajectory read_trajectory(const std::string& file);

/// Where the ZMP may be in each tick: box around the feet that stand.
struct Band {
  engine::Vec2 low = engine::Vec2::Zero();
  engine::Vec2 high = engine::Vec2::Zero();
};
std::vector<Band> read_band(const std::string& file);

/// CoM and DCM that belong to a ZMP reference: the one bounded response of the pendulum to it, held
/// over each tick. It begins to move before the reference does.
struct Response {
  std::vector<engine::Vec2> com;
  std::vector<engine::Vec2> dcm;
};
Response bounded_response(const std::vector<engine::Vec2>& zmp_reference, double tick);

struct TrackingMetrics {
  engine::Vec2 zmp_rms = engine::Vec2::Zero();  ///< ZMP from its reference, each axis [m]
  engine::Vec2 com_rms = engine::Vec2::Zero();  ///< CoM from the bounded response [m]
  /// From each kick until the DCM is within 5 mm of the bounded response, and stays so until the
  /// next kick [s].
  std::array<double, 2> settling{};
  double outside = 0.0;    ///< share of the ticks with the ZMP outside the band
  double overshoot = 0.0;  ///< greatest distance of the ZMP outside the band, on one axis [m]

  double zmp_rms_both() const { return zmp_rms.norm(); }  ///< [m]
  double com_rms_both() const { return com_rms.norm(); }  ///< [m]
};
TrackingMetrics measure(const Trajectory& trajectory, const std::vector<Band>& bands,
                        double band_tick);

/// Parameters for this walk: those of the engine, with nothing allowed for noise since there is
/// none, and by one rule instead of a search a metre of ZMP error as dear as a metre of DCM error.
engine::Parameters walk_parameters(double tick);

/// The whole engine follows the footsteps; its reference is its own (it shifts the weight within a
/// second instead of a tenth before the first and after the last step).
Trajectory walk_with_engine(const engine::Parameters& parameters);
/// Our controller alone on another program's very reference.
Trajectory track(const Trajectory& peer, const std::vector<Band>& bands,
                 const engine::Parameters& parameters);

struct PeerTracking {
  std::string name;
  bool band = false;
  TrackingMetrics peer;
  TrackingMetrics ours;  ///< our controller on the same reference
};

/// RMS of the ZMP error, both axes together, of the cheapest way back from the kicks: on each axis
/// the sum of (1 - E) E^{-i-1} (p - p_ref) after a kick has to undo the jump of the DCM, and least
/// squares do that with a ZMP error that fades as fast as the DCM error would have grown. Exact for
/// a DCM without error before each kick, over an infinite time after it [m].
double least_zmp_rms(double tick);

/// One point of the trade between ZMP and CoM.
struct WeightedTracking {
  double zmp_weight = 0.0;  ///< lqr_zmp_weight
  double dcm_gain = 0.0;    ///< K of the DCM error
  TrackingMetrics metrics;
};

struct TrackingComparison {
  std::vector<PeerTracking> peers;
  TrackingMetrics engine;               ///< at the peers' tick of 5 ms
  TrackingMetrics engine_2ms;           ///< at our usual tick
  std::vector<WeightedTracking> sweep;  ///< our controller on the first peer's reference
  /// About the least zmp_rms_both() with these kicks, whatever the controller, see least_zmp_rms()
  /// [m].
  double zmp_bound = 0.0;
};

/// Reads the four files in `folder`. Throws std::runtime_error when one cannot be read.
TrackingComparison compare_tracking(const std::string& folder);

}  // namespace stagger::sim
