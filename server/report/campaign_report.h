// A campaign as one HTML page: conditions, push limits, survival, and how to run each failed trial
// again.
#pragma once

#include <string>
#include <vector>

#include "server/campaign/summary.h"

namespace stagger::server {

/// Failed trials that are listed one by one; the page says so when there are more.
inline constexpr std::uint64_t most_listed_trials = 5000;

/// `folder`: its name, for commands that run a trial again. The same campaign gives the same bytes.
std::string campaign_report(const campaign::Plan& plan, const campaign::Store& store,
                            const campaign::Summary& summary, const std::string& folder);

struct FigureFile {
  std::string name;  ///< "limits.svg", "survival.svg" or "ablation.svg"
  std::string svg;
};
/// The page's figures for other pages and papers, each with its conditions below.
std::vector<FigureFile> campaign_figures(const campaign::Plan& plan, const campaign::Store& store,
                                         const campaign::Summary& summary);

}  // namespace stagger::server
