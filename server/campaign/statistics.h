// Intervals that hold the truth in 95 of 100 cases.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace stagger::server::campaign {

struct Estimate {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// A share of trials, with Wilson's score interval. Nothing of no trials.
std::optional<Estimate> share_of(std::uint64_t hits, std::uint64_t trials);

/// Trials that two campaigns share, by where they fail.
struct PairedCounts {
  std::uint64_t both = 0;
  std::uint64_t only_a = 0;
  std::uint64_t only_b = 0;
  std::uint64_t neither = 0;
  std::uint64_t pairs() const { return both + only_a + only_b + neither; }
};

/// Share that fails in b less that in a, with the square-and-add interval for paired shares
/// (Newcombe 1998, method 10). Nothing of no pairs.
std::optional<Estimate> paired_difference(const PairedCounts& counts);

/// Mean with Student's interval; without one (low and high infinite) of a single value.
std::optional<Estimate> mean_of(const std::vector<double>& values);

}  // namespace stagger::server::campaign
