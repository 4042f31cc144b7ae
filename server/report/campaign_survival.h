// How many trials of a campaign pass, over what it varies.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/campaign/plan.h"
#include "server/campaign/statistics.h"
#include "server/campaign/store.h"

namespace stagger::server {

/// Trials with the same place in a figure. Those that say nothing about their push do not count.
struct Survival {
  std::uint64_t passed = 0;
  std::uint64_t failed = 0;
  std::uint64_t first_failed = 0;  ///< number of the trial, when one failed

  std::uint64_t trials() const { return passed + failed; }
  std::optional<campaign::Estimate> share() const { return campaign::share_of(passed, trials()); }
};

/// A field that the campaign varies, with its values, or ranges of them, in order.
struct VariedField {
  std::string path;
  std::vector<std::string> labels;
  std::vector<double> numbers;  ///< of the labels, when all are numbers; else empty
  double bin = 0.0;             ///< width of a range; 0: each label is one value
};

/// All fields that have more than one value: factors, a list's "name", a bisection's axis.
std::vector<VariedField> varied_fields(const campaign::Plan& plan);

/// Is it how hard the push is?
bool is_hardness(const std::string& path);

/// Survival over two fields, in a panel for each combination of all others.
struct SurvivalMap {
  static constexpr std::size_t most_panels = 24;
  struct Panel {
    std::string title;
    std::vector<Survival> cells;  ///< y * (labels of x) + x
  };
  VariedField x;  ///< without a path: one column
  VariedField y;
  std::vector<Panel> panels;  ///< the first ones by trial number
  bool has_more = false;      ///< than `most_panels`

  std::size_t columns() const { return x.path.empty() ? 1 : x.labels.size(); }
  const Survival& at(const Panel& panel, std::size_t column, std::size_t row) const {
    return panel.cells[row * columns() + column];
  }
};

/// Reads the store once and keeps no trial. `pooled`: one panel for all.
SurvivalMap survival_map(const campaign::Plan& plan, const campaign::Store& store,
                         const VariedField& x, const VariedField& y, bool pooled = false);

}  // namespace stagger::server
