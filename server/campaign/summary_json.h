// summary.json of a campaign.
#pragma once

#include "server/campaign/summary.h"

namespace stagger::server::campaign {

/// {"value","low","high"}; null when there is none.
Json estimate_json(const std::optional<Estimate>& estimate);

/// What all trials share, resolved ("trial"), and the specification's base.
Json conditions_json(const Plan& plan);

/// docs/campaign.md has the fields. All but "cost" is the same however the campaign was run.
Json summary_json(const Plan& plan, const Store& store, const Summary& summary);

}  // namespace stagger::server::campaign
