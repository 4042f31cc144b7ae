// The pushes of a trial, one after another, and what the robot makes of each.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/experiment/recovery.h"
#include "sim/experiment/trial.h"
#include "sim/simulation.h"

namespace stagger::sim {

/// A push with a time is scheduled at once. Any other is when the one before it in the list has
/// ended, and then starts at once or at its phase of the gait.
class PushTrain {
 public:
  /// `stand`: the robot is to stand, not to walk.
  PushTrain(std::span<const PushSpec> pushes, bool stand);

  /// Schedules what may start from the next tick on.
  void schedule(Simulation& simulation);
  /// A push has waited too long for its trigger.
  bool overdue(std::uint64_t next_tick) const;
  /// Runs a tick and looks at what it brought. Without pushes all ticks count.
  void step(Simulation& simulation);

  bool done() const;                                      ///< all have ended
  std::optional<std::uint64_t> first_tick() const;        ///< at which one began
  double delivered_ns() const;                            ///< sum over all [N s]
  const Recovery& recovery() const { return recovery_; }  ///< from the first push on

  /// One for each push; `fell`: the robot has fallen.
  std::vector<PushOutcome> outcomes(bool fell) const;

 private:
  struct Item {
    PushSpec spec;
    Recovery recovery;  ///< until the next one starts
    std::optional<PushRecord> record;
    std::uint64_t latest = 0;  ///< tick by which it is to have begun
  };

  void look_at_pushes(const Simulation& simulation);

  std::vector<Item> items_;
  Recovery recovery_;
  std::optional<std::size_t> newest_;  ///< the push that started last
};

}  // namespace stagger::sim
