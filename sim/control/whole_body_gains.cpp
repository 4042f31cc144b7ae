#include "sim/control/whole_body_gains.h"

#include <algorithm>
#include <cmath>

#include "sim/robot/dynamic_scale.h"
#include "sim/robot/hip_flywheel.h"

namespace stagger::sim {
namespace {

/// What a swing foot's orientation loses of its phase by the delay, at its natural frequency [rad].
/// Of a delay of 5 ms kasaei falls with 0.73, h1_2 with 0.81.
constexpr double turn_phase_loss = 0.35;

/// Squared radius of gyration of the trunk as it leans, of the robot that the gains were found on
/// [m^2].
constexpr double reference_gyration = 0.0486;

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
  // An angular acceleration of the trunk counts as the linear one at its radius of gyration. By the
  // height alone the torsos of h1_2 and g1, heavy for their size, were let go: pushed backwards g1
  // fell at 0.6 m/s on its second step, by then leaning back by 0.8 rad.
  const double gyration = lean_inertia(robot) / robot.model.mass();
  gains.torso_weight *= gyration > 0.0 ? gyration / reference_gyration : angular_weight;
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
