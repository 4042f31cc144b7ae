// The paper's test of the low-level controller: six steps forward under measurement noise.
#pragma once

#include "sim/experiment/paper/closed_loop.h"

namespace stagger::sim {

struct TrackingResult {
  int seeds = 0;
  double rms_com = 0.0;    ///< true CoM - reference, sagittal, over all seeds [m]
  double rms_dcm = 0.0;    ///< true DCM - reference, likewise [m]
  double rms_com_y = 0.0;  ///< lateral [m]
  double rms_dcm_y = 0.0;  ///< lateral [m]
  double outside =
      0.0;  ///< share of ticks at which the wanted ZMP was beyond the front or rear edge
  double outside_y = 0.0;  ///< beyond a side edge
  Trace trace;             ///< of the first seed
};

/// Six steps of 0.5 m, T_ss 1 s, T_ds 0, after 1 s of standing and until 1.5 s after the last
/// landing; noise of the paper on CoM and DCM.
TrackingResult run_tracking(int seeds);

}  // namespace stagger::sim
