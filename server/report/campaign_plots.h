// Survival of a campaign's trials as pictures.
#pragma once

#include <functional>
#include <string>

#include "server/report/campaign_survival.h"
#include "server/report/svg_plot.h"

namespace stagger::server {

/// Where a trial is told of in the page ("#trial-7"), or nothing. May be empty.
using TrialLink = std::function<std::string(std::uint64_t number)>;

/// A cell for each pair of values. The legend has the intervals where they are few; else the cells
/// do, if there is room.
Plot heat_map(const SurvivalMap& map, const SurvivalMap::Panel& panel, const TrialLink& link,
              double width, std::string id);

/// A row for each value of y: share that passes, with its interval. One colour for each panel.
Plot survival_rows(const SurvivalMap& map, double width, std::string id);

/// Share that passes over x, a line with its interval for each value of y.
Plot survival_curves(const SurvivalMap& map, double width, std::string id);

}  // namespace stagger::server
