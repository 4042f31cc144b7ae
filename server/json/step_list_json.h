// A list of steps to walk.
#pragma once

#include <optional>
#include <vector>

#include "server/json/json.h"
#include "server/live/live_session.h"
#include "sim/strict_json.h"

namespace stagger::server {

struct StepList {
  std::vector<sim::Footstep> steps;
  StepFrame frame = StepFrame::world;
};

/// The fields "steps" (1 to 64 of {"side","x","y","yaw_deg"}) and "frame" ("world" or "robot").
/// Nothing when there are no steps.
std::optional<StepList> read_step_list(sim::JsonReader& reader);

/// The steps with yaw in radians under "yaw", to the bit; read_steps() takes that as well.
Json steps_json(const std::vector<sim::Footstep>& steps);
/// The field "steps" alone.
std::vector<sim::Footstep> read_steps(sim::JsonReader& reader);

}  // namespace stagger::server
