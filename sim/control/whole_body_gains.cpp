#include "sim/control/whole_body_gains.h"

#include "sim/robot/dynamic_scale.h"

namespace stagger::sim {

WholeBodyGains whole_body_gains(const Robot& robot) {
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
