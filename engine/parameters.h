// Every number that the engine can be built with, with unit, default and allowed range.
#pragma once

#include "engine/types.h"

namespace stagger::engine {

/// Which ways of keeping balance are allowed to act.
struct Strategies {
  bool ankle = true;  ///< LQG moves the ZMP inside the support polygon
  bool step = true;   ///< the place of the next step is adjusted
  bool operator==(const Strategies&) const = default;
};

/// Velocity to walk with, in the frame of the robot's heading.
struct WalkCommand {
  double vx = 0.0;  ///< forward [m/s]
  double vy = 0.0;  ///< to the left [m/s]
  double wz = 0.0;  ///< turn to the left [rad/s]
};

/// Defaults are the recommended set for the paper's robot on the LIPM (30 kg, CoM at 1 m).
struct Parameters {
  double tick = 0.002;      ///< control period [s]
  double gravity = 9.81;    ///< [m/s^2]
  double com_height = 1.0;  ///< z_c [m]

  double t_ss = 0.8;          ///< single support duration [s]
  double t_ds = 0.2;          ///< double support duration, 0 allowed [s]
  double t_init = 1.0;        ///< Initialize: weight shift before the first step [s]
  double stance_width = 0.2;  ///< lateral distance of the feet [m]
  double swing_height = 0.04; ///< z_s [m]

  double foot_half_length = 0.075;  ///< [m]
  double foot_half_width = 0.0375;  ///< [m]
  double sole_margin = 0.0;         ///< kept free inside the sole's edge when the ZMP is clamped [m]

  double max_step_length = 0.95;    ///< |x| of a step in the stance foot's frame [m]
  double min_step_width = 0.10;     ///< least lateral distance of the feet, no crossing [m]
  double max_step_width = 0.60;     ///< greatest lateral distance of the feet [m]

  // LQG weights, scaled by the control period: diag(CoM error, DCM error, integral of CoM error), ZMP.
  Vec3 lqr_state_weight{1.0, 100.0, 1.0};
  double lqr_zmp_weight = 10.0;
  double process_noise = 1e-6;        ///< variance of [c, dcm] a tick [m^2]
  double measurement_noise = 6.25e-4; ///< variance of the measured c and dcm [m^2]

  double step_gain = 1.0;      ///< k_sa of eq. (11)
  double step_margin = 0.10;   ///< compliance margin on |Delta_f| [m]
  double step_freeze = 0.06;   ///< the foothold stays as it is in the last part of the swing [s]

  double contact_load = 20.0;      ///< a swing foot that carries more has landed [N]
  double landing_patience = 0.10;  ///< how long single support waits for a late landing [s]

  Strategies strategies;
};

/// sqrt((g + zdd) / z_c) with zdd = 0: natural frequency of the LIPM [1/s]; eq. (2).
inline double natural_frequency(const Parameters& p) {
  return std::sqrt(p.gravity / p.com_height);
}

}  // namespace stagger::engine
