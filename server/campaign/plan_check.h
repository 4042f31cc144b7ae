// Whether the trials of a plan can be run, before any is.
#pragma once

#include "server/campaign/plan.h"

namespace stagger::server::campaign {

/// Looks at each value of each factor, at each entry, at every trial when there are few, and at the
/// thresholds' fields. Adds errors that point into the specification.
void check_plan(const Plan& plan, sim::JsonErrors& errors);

}  // namespace stagger::server::campaign
