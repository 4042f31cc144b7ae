// What a change of parameters takes along: made beside the control loop, handed over in one piece.
#pragma once

#include "engine/capture_region.h"
#include "engine/lqg.h"
#include "engine/parameters.h"
#include "engine/reach.h"
#include "engine/recovery.h"

namespace stagger::engine {

/// A set of parameters and everything that is worked out from it. To make one takes a while and may
/// throw, so that is done outside of the control loop; WalkingEngine::change() then only copies.
struct Tuning {
  /// Throws std::invalid_argument as the constructor of WalkingEngine does.
  explicit Tuning(const Parameters& parameters);
  /// The same with a region of footholds of one's own.
  Tuning(const Parameters& parameters, const ReachRegion& reach);

  Parameters parameters;
  ReachRegion reach;
  ReachRegion time_reach;  ///< what the step time is adjusted for
  CaptureRegion capture;
  Recovery recovery;
  Lqg lqg;
};

/// Are these of the same body in the same loop? A walking engine keeps what it was built with of:
/// tick, gravity, com_height, mass, the feet's size, sole_margin, ankle_reach, and of hip all but
/// in_steps.
bool same_body(const Parameters& a, const Parameters& b);

}  // namespace stagger::engine
