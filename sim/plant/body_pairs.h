// Which bodies of a robot may collide with each other.
#pragma once

#include <utility>
#include <vector>

#include "sim/robot/robot_model.h"

namespace stagger::sim {

/// At first every pair of bodies that have shapes may touch, but for neighbours: two bodies with
/// nothing but joints and bodies without shapes between them. The shapes of neighbours reach into
/// each other around the joint, and what keeps them apart is the joint's limits.
class BodyPairs {
 public:
  explicit BodyPairs(const RobotModel& model);

  bool may_touch(int first, int second) const { return may_touch_[cell(first, second)]; }
  void forbid(int first, int second);
  /// All pairs that may touch, each once, the lesser index first; sorted.
  std::vector<std::pair<int, int>> list() const;

 private:
  std::size_t cell(int first, int second) const {
    return static_cast<std::size_t>(first) * count_ + static_cast<std::size_t>(second);
  }

  std::size_t count_;
  std::vector<bool> may_touch_;
};

}  // namespace stagger::sim
