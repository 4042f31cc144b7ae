#include "sim/control/whole_body_gains.h"

#include <algorithm>
#include <cmath>

#include "sim/robot/dynamic_scale.h"

namespace stagger::sim {
namespace {

/// What a swing foot's orientation loses of its phase by the delay, at its natural frequency [rad].
/// Of a delay of 5 ms kasaei falls with 0.73, h1_2 with 0.81.
constexpr double turn_phase_loss = 0.35;

}  // namespace

WholeBodyGains whole_body_gains(const Robot& robot, double loop_delay) {
  const DynamicScale scale = dynamic_scale(robot);
  const double frequency = scale.frequency();
  const double stiffness = frequency * frequency;
  const double angular_weight = scale.length * scale.length;
  WholeBodyGains gains;
  for (double* k : {&gains.height_stiffness, &gains.torso_stiffness, &gains.swing_stiffness,
                    &gains.limit_braking, &gains.limit_return}) {
    *k *= stiffness;
  }
  for (double* d : {&gains.height_damping, &gains.torso_damping, &gains.swing_damping,
                    &gains.stance_damping, &gains.limit_damping}) {
    *d *= frequency;
  }
  const double swing_frequency = std::sqrt(gains.swing_stiffness);
  const double turn_frequency = std::max(swing_frequency, turn_phase_loss / loop_delay);
  gains.swing_turn_stiffness = turn_frequency * turn_frequency;
  gains.swing_turn_damping = 2.0 * turn_frequency;
  gains.swing_turn_acceleration_limit /= scale.length;
  gains.torso_weight *= angular_weight;
  gains.limit_weight *= angular_weight;
  gains.ankle_limit_weight *= angular_weight;
  // A rate of momentum is a mass, a length and an acceleration.
  gains.momentum_weight /= scale.mass * scale.mass * angular_weight;
  gains.acceleration_regularisation *= angular_weight;
  gains.force_regularisation /= scale.mass * scale.mass;
  gains.angular_length *= scale.length;
  gains.sole_margin *= scale.length;
  gains.least_normal_force *= scale.mass;
  gains.fallback_damping *= scale.damping();
  return gains;
}

}  // namespace stagger::sim
