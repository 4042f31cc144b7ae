// What a campaign found as tables of its report.
#pragma once

#include <set>

#include "server/campaign/summary.h"
#include "server/report/html_page.h"

namespace stagger::server {

Table thresholds_table(const campaign::Summary& summary);
/// Counts and pass rates with intervals, by value of each factor.
Table groups_table(const campaign::Summary& summary);
/// A bisection's limits in every unit.
Table limits_table(const campaign::Plan& plan, const campaign::Summary& summary);
Table published_table();

/// Trials that did not pass: how they ended and how to run them again.
struct FailedTrials {
  Table table;
  std::uint64_t count = 0;         ///< those that are not listed too
  std::set<std::uint64_t> listed;  ///< numbers
};
FailedTrials failed_trials(const campaign::Store& store, const std::string& folder);

/// "trial-7": where a trial is listed.
std::string trial_anchor(std::uint64_t number);

}  // namespace stagger::server
