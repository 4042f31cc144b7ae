#include "sim/parameter_table.h"

#include <algorithm>
#include <array>
#include <type_traits>

namespace stagger::sim {
namespace {

using enum ParameterKind;
using enum TakesEffect;

enum class Of : std::uint8_t { both, bullet, lipm };

/// Multiples of the robot's own value, so that they suit a robot of any size.
struct OfDefault {
  double least;
  double most;
};
struct Between {
  double least;
  double most;
};

struct Row {
  std::string_view name;
  std::string_view unit;
  std::string_view meaning;
  ParameterKind kind = number;
  TakesEffect takes_effect = next_step;
  Of plants = Of::both;
};

/// `Field` gives a reference to the parameter in a WorldParameters.
template <typename Field>
constexpr ParameterInfo row(const Row& row, double least, double most, bool of_default,
                            Field /*type*/) {
  return {row.name,
          row.unit,
          row.meaning,
          least,
          most,
          of_default,
          row.kind,
          row.takes_effect,
          row.plants != Of::lipm,
          row.plants != Of::bullet,
          [](const WorldParameters& p) { return static_cast<double>(Field()(p)); },
          [](WorldParameters& p, double value) {
            auto& field = Field()(p);
            field = static_cast<std::remove_reference_t<decltype(field)>>(value);
          }};
}

template <typename Field>
constexpr ParameterInfo row(const Row& about, Between range, Field field) {
  return row(about, range.least, range.most, false, field);
}

template <typename Field>
constexpr ParameterInfo row(const Row& about, OfDefault range, Field field) {
  return row(about, range.least, range.most, true, field);
}

/// The same parameter in two places.
constexpr ParameterInfo with_set(ParameterInfo info, void (*set)(WorldParameters&, double)) {
  info.set = set;
  return info;
}

constexpr std::array table{
    row(
        {"gait.t_ss", "s", "duration of single support"}, OfDefault{0.5, 3.0},
        [](auto& p) -> auto& { return p.engine.t_ss; }),
    row(
        {"gait.t_ds", "s", "duration of double support"}, Between{0.0, 2.0},
        [](auto& p) -> auto& { return p.engine.t_ds; }),
    row(
        {"gait.t_init", "s",
         "weight shift before the first step, and back to the middle after the last"},
        OfDefault{0.3, 4.0}, [](auto& p) -> auto& { return p.engine.t_init; }),
    with_set(
        row(
            {"gait.com_height", "m", "height of the CoM above the soles while walking", number,
             reset},
            OfDefault{0.85, 1.1}, [](auto& p) -> auto& { return p.engine.com_height; }),
        [](WorldParameters& p, double value) { p.engine.com_height = p.lipm.com_height = value; }),
    row(
        {"gait.stance_width", "m", "lateral distance of the feet"}, OfDefault{0.5, 2.0},
        [](auto& p) -> auto& { return p.engine.stance_width; }),
    row(
        {"gait.swing_height", "m", "how high a foot is lifted in mid-swing"}, OfDefault{0.1, 4.0},
        [](auto& p) -> auto& { return p.engine.swing_height; }),
    row(
        {"gait.contact_load", "N", "a swing foot that carries more has landed"},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.engine.contact_load; }),
    row(
        {"gait.landing_patience", "s", "how long single support waits for a late landing"},
        Between{0.0, 1.0}, [](auto& p) -> auto& { return p.engine.landing_patience; }),
    row(
        {"gait.landing_speed", "m/s", "of a late foot on its way down to the ground"},
        Between{0.0, 2.0}, [](auto& p) -> auto& { return p.engine.landing_speed; }),
    row(
        {"gait.landing_acceleration", "m/s^2", "by which a late foot then goes down faster"},
        Between{0.0, 20.0}, [](auto& p) -> auto& { return p.engine.landing_acceleration; }),
    row(
        {"gait.landing_rate", "1/s",
         "of a late foot's way over the ground to where the DCM has gone; 0: it stays where it is"},
        Between{0.0, 500.0}, [](auto& p) -> auto& { return p.engine.landing_rate; }),
    row(
        {"gait.hold_load", "N",
         "a swing foot that carries more in the first half of its way waits to be let go"},
        OfDefault{0.1, 100.0}, [](auto& p) -> auto& { return p.engine.hold_load; }),
    row(
        {"step.max_length", "m", "longest step forward"}, OfDefault{0.1, 2.0},
        [](auto& p) -> auto& { return p.engine.max_step_length; }),
    row(
        {"step.max_back", "m", "longest step backward"}, OfDefault{0.1, 2.0},
        [](auto& p) -> auto& { return p.engine.max_step_back; }),
    row(
        {"step.min_width", "m", "least lateral distance of the feet in a step"}, Between{-0.5, 2.0},
        [](auto& p) -> auto& { return p.engine.min_step_width; }),
    row(
        {"step.max_width", "m", "greatest lateral distance of the feet in a step"},
        OfDefault{0.5, 2.0}, [](auto& p) -> auto& { return p.engine.max_step_width; }),
    row(
        {"step.max_turn", "rad", "greatest turn of a foot against the one that stands"},
        Between{0.01, 1.5}, [](auto& p) -> auto& { return p.engine.max_step_turn; }),
    row(
        {"step.foot_clearance", "m", "least gap between the two soles"}, Between{0.0, 0.2},
        [](auto& p) -> auto& { return p.engine.foot_clearance; }),
    row(
        {"step.allow_crossing", "",
         "an adjusted step may land across the other foot; nothing keeps the legs from touching",
         flag},
        Between{0.0, 1.0}, [](auto& p) -> auto& { return p.engine.allow_crossing; }),
    row(
        {"step.speed", "m/s", "greatest speed of the swing foot"}, Between{0.1, 1000000000.0},
        [](auto& p) -> auto& { return p.engine.swing_speed; }),
    row(
        {"step.acceleration", "m/s^2",
         "greatest acceleration of the swing foot; an adjusted step gets the time that it needs"},
        Between{1.0, 1000000000.0}, [](auto& p) -> auto& { return p.engine.swing_acceleration; }),
    row(
        {"adjust.ankle_share", "",
         "share of the sole by which the ankle is reckoned to help before a step is adjusted"},
        Between{0.0, 1.0}, [](auto& p) -> auto& { return p.engine.ankle_share; }),
    row(
        {"adjust.gain", "", "k_sa of eq. (11): gain of the adjustment of place"},
        Between{0.0, 10.0}, [](auto& p) -> auto& { return p.engine.step_gain; }),
    row(
        {"adjust.margin", "m", "a foothold that is off by less is not adjusted"}, Between{0.0, 0.5},
        [](auto& p) -> auto& { return p.engine.step_margin; }),
    row(
        {"adjust.freeze", "s", "place and time stay as they are in this last part of the swing"},
        Between{0.0, 1.0}, [](auto& p) -> auto& { return p.engine.step_freeze; }),
    row(
        {"adjust.anew", "m",
         "a step that misses its catching foothold by more is taken anew in its last part, too"},
        Between{0.0, 1000000000.0}, [](auto& p) -> auto& { return p.engine.step_anew; }),
    row(
        {"adjust.time_limit", "s", "greatest change of the duration of single support"},
        Between{0.0, 5.0}, [](auto& p) -> auto& { return p.engine.time_limit; }),
    row(
        {"adjust.time_constant", "s", "of the lag filter of eq. (13), for the adjustment of time"},
        Between{0.001, 10.0}, [](auto& p) -> auto& { return p.engine.time_constant; }),
    row(
        {"adjust.time_reach", "",
         "a step longer than this share of the reach comes sooner as well"},
        Between{0.01, 1.0}, [](auto& p) -> auto& { return p.engine.time_reach; }),
    row(
        {"adjust.least_t_ss", "s", "no single support is adjusted to less"}, Between{0.02, 5.0},
        [](auto& p) -> auto& { return p.engine.least_t_ss; }),
    row(
        {"lqg.com_weight", "", "LQR weight of the CoM error"}, Between{0.0, 1000000.0},
        [](auto& p) -> auto& { return p.engine.lqr_state_weight[0]; }),
    row(
        {"lqg.dcm_weight", "", "LQR weight of the DCM error"}, Between{0.0, 1000000.0},
        [](auto& p) -> auto& { return p.engine.lqr_state_weight[1]; }),
    row(
        {"lqg.integral_weight", "",
         "LQR weight of the integral of the CoM error; 0: no integrator"},
        Between{0.0, 1000000.0}, [](auto& p) -> auto& { return p.engine.lqr_state_weight[2]; }),
    row(
        {"lqg.zmp_weight", "", "LQR weight of the ZMP"}, Between{0.001, 1000000.0},
        [](auto& p) -> auto& { return p.engine.lqr_zmp_weight; }),
    row(
        {"lqg.process_noise", "m^2", "Kalman filter: variance of CoM and DCM that a tick adds"},
        Between{1e-12, 0.01}, [](auto& p) -> auto& { return p.engine.process_noise; }),
    row(
        {"lqg.measurement_noise", "m^2", "Kalman filter: variance of the measured CoM and DCM"},
        Between{1e-12, 0.1}, [](auto& p) -> auto& { return p.engine.measurement_noise; }),
    row(
        {"lqg.push_gate", "", "innovations beyond this many standard deviations are a push"},
        Between{0.5, 1000000000.0}, [](auto& p) -> auto& { return p.engine.push_gate; }),
    row(
        {"hip.in_steps", "", "the hips swing also while steps are adjusted", flag},
        Between{0.0, 1.0}, [](auto& p) -> auto& { return p.engine.hip.in_steps; }),
    row(
        {"hip.torque", "N m",
         "greatest torque that the hip strategy reckons with; 0: no hip strategy", number, reset},
        Between{0.0, 1000.0}, [](auto& p) -> auto& { return p.engine.hip.torque; }),
    row(
        {"hip.inertia", "kg m^2", "of the upper body, as the hip strategy reckons with it", number,
         reset},
        Between{0.0001, 1000.0}, [](auto& p) -> auto& { return p.engine.hip.inertia; }),
    row(
        {"hip.angle", "rad", "greatest lean", number, reset}, Between{0.0, 1.5},
        [](auto& p) -> auto& { return p.engine.hip.angle; }),
    row(
        {"hip.rate", "rad/s", "greatest angular velocity of the lean", number, reset},
        Between{0.0, 1000000000.0}, [](auto& p) -> auto& { return p.engine.hip.rate; }),
    with_set(row(
                 {"sole.margin", "m", "the ZMP is kept this far inside the edge of the sole",
                  number, reset},
                 Between{0.0, 0.1}, [](auto& p) -> auto& { return p.engine.sole_margin; }),
             [](WorldParameters& p, double value) {
               p.engine.sole_margin = p.gains.sole_margin = value;
             }),
    row(
        {"sole.ankle_reach_length", "m",
         "the ankle moves the ZMP no farther from the middle, along the sole", number, reset},
        Between{0.001, 1000000000.0}, [](auto& p) -> auto& { return p.engine.ankle_reach[0]; }),
    row(
        {"sole.ankle_reach_width", "m",
         "the ankle moves the ZMP no farther from the middle, across the sole", number, reset},
        Between{0.001, 1000000000.0}, [](auto& p) -> auto& { return p.engine.ankle_reach[1]; }),
    row(
        {"body.com_weight", "", "weight of the horizontal acceleration of the CoM", number,
         next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.com_weight; }),
    row(
        {"body.height_weight", "", "weight of the vertical acceleration of the CoM", number,
         next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.height_weight; }),
    row(
        {"body.height_stiffness", "1/s^2", "of the height of the CoM", number, next_step,
         Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.height_stiffness; }),
    row(
        {"body.height_damping", "1/s", "of the height of the CoM", number, next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.height_damping; }),
    row(
        {"body.momentum_weight", "",
         "weight of the rate of angular momentum that the hip strategy asks for", number, next_step,
         Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.momentum_weight; }),
    row(
        {"body.torso_weight", "", "weight of the orientation of the torso", number, next_step,
         Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.torso_weight; }),
    row(
        {"body.torso_stiffness", "1/s^2", "of the orientation of the torso", number, next_step,
         Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.torso_stiffness; }),
    row(
        {"body.torso_damping", "1/s", "of the orientation of the torso", number, next_step,
         Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.torso_damping; }),
    row(
        {"body.swing_weight", "", "weight of the swing foot", number, next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.swing_weight; }),
    row(
        {"body.swing_stiffness", "1/s^2", "of the swing foot", number, next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.swing_stiffness; }),
    row(
        {"body.swing_damping", "1/s", "of the swing foot", number, next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.swing_damping; }),
    row(
        {"body.swing_turn_stiffness", "1/s^2", "of the orientation of the swing foot", number,
         next_step, Of::bullet},
        OfDefault{0.01, 10.0}, [](auto& p) -> auto& { return p.gains.swing_turn_stiffness; }),
    row(
        {"body.swing_turn_damping", "1/s", "of the orientation of the swing foot", number,
         next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.swing_turn_damping; }),
    row(
        {"body.swing_turn_acceleration_limit", "rad/s^2",
         "greatest angular acceleration asked of the swing foot", number, next_step, Of::bullet},
        OfDefault{0.1, 10.0},
        [](auto& p) -> auto& { return p.gains.swing_turn_acceleration_limit; }),
    row(
        {"body.swing_acceleration_limit", "m/s^2", "greatest acceleration asked of the swing foot",
         number, next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.swing_acceleration_limit; }),
    row(
        {"body.stance_weight", "", "weight of keeping a standing foot still", number, next_step,
         Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.stance_weight; }),
    row(
        {"body.stance_damping", "1/s", "of a standing foot", number, next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.stance_damping; }),
    row(
        {"body.angular_length", "m", "what an angle of a foot counts as against a length", number,
         next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.angular_length; }),
    row(
        {"body.acceleration_regularisation", "", "weight of joint accelerations", number, next_step,
         Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.acceleration_regularisation; }),
    row(
        {"body.force_regularisation", "", "weight of contact forces", number, next_step,
         Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.force_regularisation; }),
    row(
        {"body.friction", "", "friction that the controller counts on, each axis of the pyramid",
         number, next_step, Of::bullet},
        Between{0.05, 2.0}, [](auto& p) -> auto& { return p.gains.friction; }),
    row(
        {"body.least_normal_force", "N", "least normal force at each corner of a standing sole",
         number, next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.least_normal_force; }),
    row(
        {"body.limit_weight", "", "weight of braking a joint before the end of its range", number,
         next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.limit_weight; }),
    row(
        {"body.ankle_limit_weight", "", "the same of ankles", number, next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.ankle_limit_weight; }),
    row(
        {"body.limit_braking", "rad/s^2",
         "braking by which a joint is stopped at the end of its range", number, next_step,
         Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.limit_braking; }),
    row(
        {"body.limit_damping", "1/s", "of a joint that is faster than can be stopped there", number,
         next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.limit_damping; }),
    row(
        {"body.limit_return", "1/s^2", "stiffness of a joint beyond its margin", number, next_step,
         Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.limit_return; }),
    row(
        {"body.limit_margin", "rad", "margin before the end of a joint's range", number, next_step,
         Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.limit_margin; }),
    row(
        {"body.leg_stretch", "",
         "the CoM sinks rather than let a leg be longer than this share of its length", number,
         next_step, Of::bullet},
        Between{0.8, 1.0}, [](auto& p) -> auto& { return p.gains.leg_stretch; }),
    row(
        {"body.fallback_damping", "N m s", "torque per joint velocity when a solve has failed",
         number, next_step, Of::bullet},
        OfDefault{0.1, 10.0}, [](auto& p) -> auto& { return p.gains.fallback_damping; }),
    row(
        {"sensors.gyro_noise", "rad/s", "standard deviation of the gyro, each axis", number, reset,
         Of::bullet},
        Between{0.0, 1.0}, [](auto& p) -> auto& { return p.senses.sensors.imu.gyro_noise; }),
    row(
        {"sensors.gyro_bias", "rad/s", "standard deviation of the gyro's constant error", number,
         reset, Of::bullet},
        Between{0.0, 1.0}, [](auto& p) -> auto& { return p.senses.sensors.imu.gyro_bias; }),
    row(
        {"sensors.accelerometer_noise", "m/s^2",
         "standard deviation of the accelerometer, each axis", number, reset, Of::bullet},
        Between{0.0, 10.0},
        [](auto& p) -> auto& { return p.senses.sensors.imu.accelerometer_noise; }),
    row(
        {"sensors.accelerometer_bias", "m/s^2",
         "standard deviation of the accelerometer's constant error", number, reset, Of::bullet},
        Between{0.0, 10.0},
        [](auto& p) -> auto& { return p.senses.sensors.imu.accelerometer_bias; }),
    row(
        {"sensors.imu_delay_ticks", "ticks", "age of a reading of gyro and accelerometer", whole,
         reset, Of::bullet},
        Between{0.0, 20.0}, [](auto& p) -> auto& { return p.senses.sensors.imu.delay_ticks; }),
    row(
        {"sensors.joint_position_noise", "rad", "standard deviation of the measured joint angles",
         number, reset, Of::bullet},
        Between{0.0, 0.1},
        [](auto& p) -> auto& { return p.senses.sensors.encoder.position_noise; }),
    row(
        {"sensors.joint_velocity_noise", "rad/s",
         "standard deviation of the measured joint velocities", number, reset, Of::bullet},
        Between{0.0, 10.0},
        [](auto& p) -> auto& { return p.senses.sensors.encoder.velocity_noise; }),
    row(
        {"sensors.foot_force_noise", "",
         "standard deviation of a foot's measured force, in shares of the weight", number, reset,
         Of::bullet},
        Between{0.0, 1.0}, [](auto& p) -> auto& { return p.senses.sensors.foot.force_noise; }),
    row(
        {"sensors.foot_force_bias", "",
         "standard deviation of its constant error, in shares of the weight", number, reset,
         Of::bullet},
        Between{0.0, 1.0}, [](auto& p) -> auto& { return p.senses.sensors.foot.force_bias; }),
    row(
        {"sensors.foot_moment_noise", "",
         "standard deviation of a foot's measured moment, in shares of weight times sole length",
         number, reset, Of::bullet},
        Between{0.0, 1.0}, [](auto& p) -> auto& { return p.senses.sensors.foot.moment_noise; }),
    row(
        {"sensors.foot_moment_bias", "",
         "standard deviation of its constant error, in the same shares", number, reset, Of::bullet},
        Between{0.0, 1.0}, [](auto& p) -> auto& { return p.senses.sensors.foot.moment_bias; }),
    row(
        {"physics.friction", "",
         "Coulomb coefficient of the ground, but for its patches; in place of the terrain's own",
         number, reset, Of::bullet},
        Between{0.1, 0.8}, [](auto& p) -> auto& { return p.ground_friction; }),
    row(
        {"physics.iterations", "", "iterations of the constraint solver", whole, reset, Of::bullet},
        Between{1.0, 200.0}, [](auto& p) -> auto& { return p.physics.iterations; }),
    row(
        {"lipm.noise", "m", "standard deviation of the measured CoM and DCM, each axis", number,
         reset, Of::lipm},
        Between{0.0, 0.1}, [](auto& p) -> auto& { return p.lipm.noise; }),
    row(
        {"lipm.delay", "s", "age of the measurement", number, reset, Of::lipm}, Between{0.0, 0.1},
        [](auto& p) -> auto& { return p.lipm.delay; }),
};

}  // namespace

std::span<const ParameterInfo> parameter_table() { return table; }

const ParameterInfo* find_parameter(std::string_view name) {
  const auto* const found = std::find_if(table.begin(), table.end(),
                                         [name](const auto& row) { return row.name == name; });
  return found == table.end() ? nullptr : found;
}

}  // namespace stagger::sim
