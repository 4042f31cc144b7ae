// What a figure of the paper is drawn from: references and what really happened, tick by tick.
#pragma once

#include <vector>

#include "engine/types.h"

namespace stagger::sim {

/// Reference and truth of one point on the ground [m].
struct TracedPoint {
  engine::Vec2 reference = engine::Vec2::Zero();
  engine::Vec2 actual = engine::Vec2::Zero();
  engine::Vec2 error() const { return actual - reference; }
};

struct TraceSample {
  double time = 0.0;  ///< [s]
  TracedPoint zmp;
  TracedPoint com;
  TracedPoint dcm;
  /// Bounding box of the support polygon [m].
  engine::Vec2 sole_low = engine::Vec2::Zero();
  engine::Vec2 sole_high = engine::Vec2::Zero();
};
using Trace = std::vector<TraceSample>;

}  // namespace stagger::sim
