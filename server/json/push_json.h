// The push object: one form in requests, trials, answers and shared links.
#pragma once

#include "server/json/json.h"
#include "sim/plant/push.h"
#include "sim/strict_json.h"

namespace stagger::server {

/// Reads the push object of docs/api.md. What is wrong goes to the reader's errors; the push that
/// is returned counts only when there are none. The link is not looked up: that takes a robot.
sim::PushSpec read_push(sim::JsonReader& reader);

/// Every field that has a value; reading it again gives the same push to the bit. `point` is left
/// out for the link's centre of mass, `trigger` and `at_s` for a push that starts at once.
Json push_spec_json(const sim::PushSpec& push);

/// The push resource: what was asked for and what has become of it. `tick_s` is the length of a
/// tick [s].
Json push_record_json(const sim::PushRecord& record, double tick_s);

}  // namespace stagger::server
