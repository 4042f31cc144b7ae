// When a pushed robot is back at what it was told to do: the commanded gait, or standing.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/simulation.h"

namespace stagger::sim {

/// A step that lands farther than this from its plan is a recovery step, and a DCM farther than
/// this from its reference is not back yet [m]. Undisturbed, kasaei stays within 4 mm of it in
/// place and within 27 mm at its fastest walks.
inline constexpr double recovery_tolerance = 0.03;

/// Watches a robot from its push on. It is back once no recovery step is under way any more, the
/// measured DCM stays near its reference, and the state is what was commanded: idle or not. The
/// reference is laid through the feet as they landed, with steps of the commanded velocity: a robot
/// that follows it and takes its steps as planned walks as commanded.
class Recovery {
 public:
  /// `stand`: the robot is to stand, not to walk.
  explicit Recovery(bool stand) : stand_(stand) {}

  /// Looks at the tick that has just been run.
  void look(const Frame& frame);
  /// Counts the steps of all events since the push began.
  void take(const std::vector<Event>& events);

  /// Steps since the push began until the last recovery step; 0: there was none.
  std::uint64_t steps() const { return last_recovery_; }
  /// First tick from which on the robot was back for good; nothing when it was not by the last tick
  /// that was looked at. 0 when it was never away.
  std::optional<std::uint64_t> back_tick() const;

 private:
  bool stand_;
  std::uint64_t steps_ = 0;
  std::uint64_t last_recovery_ = 0;
  std::uint64_t back_ = 0;
  std::uint64_t next_ = 0;  ///< tick after the last one looked at
};

}  // namespace stagger::sim
