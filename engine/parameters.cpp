#include "engine/parameters.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace stagger::engine {
namespace {

constexpr double unlimited = 1e9;

std::string complaint(const std::string& name, double value, const std::string& allowed) {
  std::ostringstream text;
  text << "engine parameter " << name << " = " << value << "; allowed: " << allowed;
  return text.str();
}

[[noreturn]] void refuse(const std::string& name, double value, const std::string& allowed) {
  throw ParameterError(name, value, allowed);
}

std::string described(double least, double most, const char* unit) {
  std::ostringstream text;
  text << least << " to " << most << ' ' << unit;
  return text.str();
}

/// Written so that a NaN is refused.
void within(const char* name, double value, double least, double most, const char* unit) {
  if (!(value >= least && value <= most)) refuse(name, value, described(least, most, unit));
}

/// Rules that tie one value to another.
void at_least(const char* name, double value, double least, const std::string& rule) {
  if (value >= least) return;
  std::ostringstream text;
  text << "at least " << rule << " (" << least << ')';
  refuse(name, value, text.str());
}

void at_most(const char* name, double value, double most, const std::string& rule) {
  if (value <= most) return;
  std::ostringstream text;
  text << "at most " << rule << " (" << most << ')';
  refuse(name, value, text.str());
}

void validate_ranges(const Parameters& p) {
  within("tick", p.tick, 1e-5, 0.05, "s");
  within("gravity", p.gravity, 0.1, 100.0, "m/s^2");
  within("com_height", p.com_height, 0.01, 10.0, "m");
  within("mass", p.mass, 1e-3, 1e5, "kg");

  within("t_ss", p.t_ss, 0.01, 60.0, "s");
  within("t_ds", p.t_ds, 0.0, 60.0, "s");
  within("t_init", p.t_init, 0.01, 60.0, "s");
  within("stance_width", p.stance_width, 0.001, 5.0, "m");
  within("swing_height", p.swing_height, 0.0, 1.0, "m");

  within("foot_half_length", p.foot_half_length, 1e-4, 2.0, "m");
  within("foot_half_width", p.foot_half_width, 1e-4, 2.0, "m");
  within("sole_margin", p.sole_margin, 0.0, 1.0, "m");
  within("ankle_reach (length)", p.ankle_reach.x(), 1e-4, unlimited, "m");
  within("ankle_reach (width)", p.ankle_reach.y(), 1e-4, unlimited, "m");

  within("max_step_length", p.max_step_length, 1e-3, 5.0, "m");
  within("max_step_back", p.max_step_back, 1e-3, 5.0, "m");
  within("min_step_width", p.min_step_width, -5.0, 5.0, "m");
  within("max_step_width", p.max_step_width, 0.001, 5.0, "m");
  within("max_step_turn", p.max_step_turn, 1e-3, 1.5, "rad");
  within("foot_clearance", p.foot_clearance, 0.0, 1.0, "m");

  constexpr double most_weight = 1e12;
  within("lqr_state_weight (CoM)", p.lqr_state_weight[0], 0.0, most_weight, "");
  within("lqr_state_weight (DCM)", p.lqr_state_weight[1], 0.0, most_weight, "");
  within("lqr_state_weight (integral)", p.lqr_state_weight[2], 0.0, most_weight, "");
  within("lqr_zmp_weight", p.lqr_zmp_weight, 1e-12, most_weight, "");
  within("process_noise", p.process_noise, 1e-18, 1.0, "m^2");
  within("measurement_noise", p.measurement_noise, 1e-18, 1.0, "m^2");
  within("push_gate", p.push_gate, 0.1, unlimited, "standard deviations");

  within("ankle_share", p.ankle_share, 0.0, 1.0, "");
  within("step_gain", p.step_gain, 0.0, 10.0, "");
  within("step_margin", p.step_margin, 0.0, unlimited, "m");
  within("step_freeze", p.step_freeze, 0.0, 60.0, "s");
  within("step_anew", p.step_anew, 0.0, unlimited, "m");
  within("time_limit", p.time_limit, 0.0, 60.0, "s");
  within("time_constant", p.time_constant, 1e-6, unlimited, "s");
  within("time_reach", p.time_reach, 0.01, 1.0, "");
  within("least_t_ss", p.least_t_ss, 0.01, 60.0, "s");
  within("swing_speed", p.swing_speed, 1e-3, unlimited, "m/s");
  within("swing_acceleration", p.swing_acceleration, 1e-3, unlimited, "m/s^2");
  within("contact_load", p.contact_load, 0.0, unlimited, "N");
  within("landing_patience", p.landing_patience, 0.0, unlimited, "s");
  within("landing_speed", p.landing_speed, 0.0, unlimited, "m/s");
  within("landing_acceleration", p.landing_acceleration, 0.0, unlimited, "m/s^2");
  within("landing_rate", p.landing_rate, 0.0, unlimited, "1/s");
  within("hold_load", p.hold_load, 0.0, unlimited, "N");

  within("hip.torque", p.hip.torque, 0.0, unlimited, "N m");
  within("hip.inertia", p.hip.inertia, 1e-6, unlimited, "kg m^2");
  within("hip.angle", p.hip.angle, 0.0, unlimited, "rad");
  within("hip.rate", p.hip.rate, 0.0, unlimited, "rad/s");
}

void validate_together(const Parameters& p) {
  // Fewer ticks than these in a swing and neither the filter nor the adjusters can do their work.
  constexpr double least_ticks = 5.0;
  at_least("t_ss", p.t_ss, least_ticks * p.tick, "5 ticks");
  at_least("t_init", p.t_init, least_ticks * p.tick, "5 ticks");
  at_least("least_t_ss", p.least_t_ss, least_ticks * p.tick, "5 ticks");
  at_most("least_t_ss", p.least_t_ss, p.t_ss, "t_ss");
  if (p.step_freeze >= p.t_ss) {
    refuse("step_freeze", p.step_freeze, "less than t_ss (" + std::to_string(p.t_ss) + ')');
  }

  const double half = std::min(p.foot_half_length, p.foot_half_width);
  if (p.sole_margin >= half) {
    refuse("sole_margin", p.sole_margin,
           "less than half the sole's width and length (" + std::to_string(half) + ')');
  }
  // What keeps two parallel soles apart side by side, but for a rounding error.
  const double apart = 2.0 * p.foot_half_width + p.foot_clearance - 1e-9;
  const std::string side_by_side = "2 foot_half_width + foot_clearance";
  if (p.allow_crossing) {
    at_least("stance_width", p.stance_width, apart, side_by_side);
    at_least("min_step_width", p.min_step_width, -p.max_step_width, "-max_step_width");
  } else {
    at_least("min_step_width", p.min_step_width, apart, side_by_side + ", unless allow_crossing");
  }
  at_least("stance_width", p.stance_width, p.min_step_width, "min_step_width");
  at_least("max_step_width", p.max_step_width, p.stance_width, "stance_width");
  if (p.min_step_width >= p.max_step_width) {
    refuse("min_step_width", p.min_step_width,
           "less than max_step_width (" + std::to_string(p.max_step_width) + ')');
  }
}

}  // namespace

ParameterError::ParameterError(std::string name, double value, std::string allowed)
    : std::invalid_argument(complaint(name, value, allowed)),
      name_(std::move(name)),
      value_(value),
      allowed_(std::move(allowed)) {}

const Parameters& validate(const Parameters& parameters) {
  validate_ranges(parameters);
  validate_together(parameters);
  return parameters;
}

}  // namespace stagger::engine
