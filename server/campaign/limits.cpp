#include "server/campaign/limits.h"

namespace stagger::server::campaign {

std::vector<CellLimit> limits_of(const Plan& plan, const Store& store) {
  std::vector<CellLimit> limits;
  const Design& design = plan.design();
  if (!design.is_bisection()) return limits;
  for (std::uint64_t cell = 0; cell < design.cells(); ++cell) {
    CellLimit found;
    found.limit = design.limit(cell, store);
    found.values = Json::object();
    auto settings = design.settings({cell, 0, 0});
    settings.pop_back();  // the axis
    for (const auto& [path, value] : settings) found.values[path] = value;
    const auto level = [&](const std::optional<std::uint64_t>& index) {
      return index ? std::optional(design.level(*index)) : std::nullopt;
    };
    found.pass = level(found.limit.pass);
    found.fail = level(found.limit.fail);
    found.highest_pass = level(found.limit.highest_pass);
    // Every cell runs level 0.
    const auto trial = store.find(design.number({cell, found.limit.pass.value_or(0), 0}));
    if (trial) found.ceiling_dv = trial->ceiling_dv;
    if (trial && found.limit.pass) found.at_pass = trial->push;
    limits.push_back(std::move(found));
  }
  return limits;
}

}  // namespace stagger::server::campaign
