// The push limits that a bisection found, in every unit.
#pragma once

#include <optional>
#include <vector>

#include "server/campaign/plan.h"
#include "server/campaign/store.h"
#include "server/json/json.h"

namespace stagger::server::campaign {

/// The push limit of one cell of a bisection.
struct CellLimit {
  Json values;  ///< of its factors
  Limit limit;
  std::optional<double> pass;  ///< the axis' own unit
  std::optional<double> fail;
  std::optional<double> highest_pass;
  std::optional<PushFigures> at_pass;
  std::optional<double> ceiling_dv;  ///< [m/s]
};

/// One for each cell; none of another design.
std::vector<CellLimit> limits_of(const Plan& plan, const Store& store);

}  // namespace stagger::server::campaign
