// What no controller of the linear inverted pendulum could do better in a trial.
#pragma once

#include <optional>

#include "sim/experiment/trial.h"

namespace stagger::sim {

/// Greatest delta-v [m/s] of the trial's push, in its direction and with its duration, after which
/// a pendulum of the robot's height, soles, step limits and step times can avoid a fall with the
/// trial's strategies. All of the sole counts whether the ankle is a strategy or not. With a
/// trigger that names no leg: of the leg for which it is greater.
///
/// Nothing where no ceiling is known: no push; one that is not horizontal or not rectangular; a
/// walking robot that is not pushed at a phase of single support; a walk that turns; a walk
/// sideways whose steps stay as planned. docs/capturability.md derives it.
std::optional<double> trial_ceiling(const TrialSpec& spec, const Robot& robot);

}  // namespace stagger::sim
