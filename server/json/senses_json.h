// What control knows of the robot's state, and how late it acts: the words of trials, requests and
// answers.
#pragma once

#include "server/json/json.h"
#include "sim/control/senses.h"
#include "sim/plant/plant.h"
#include "sim/strict_json.h"

namespace stagger::server {

inline constexpr std::int64_t max_control_delay_ms = 10;

/// The fields "state" ("estimated" or "perfect") and "control_delay_ms" (a whole number, 0 to 10);
/// what is left out is as in `otherwise`.
sim::SenseParameters read_senses(sim::JsonReader& reader, const sim::SenseParameters& otherwise);

std::string_view name_of_state(const sim::SenseParameters& senses);
/// Is that the name of a state that is perfect? For the command line, which has checked it.
bool is_perfect_state(std::string_view name);
std::int64_t control_delay_ms(const sim::SenseParameters& senses);
void set_control_delay_ms(sim::SenseParameters& senses, std::int64_t ms);

/// Writes both fields; null on the pendulum, which has noise and delay of its own.
void write_senses(Json& json, sim::PlantKind plant, const sim::SenseParameters& senses);

}  // namespace stagger::server
