#include "server/campaign/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace stagger::server::campaign {
namespace {

constexpr double z = 1.959963984540054;  ///< 97.5 % of the normal distribution lie below

/// The same of Student's distribution: Cornish and Fisher's expansion in 1/n, off by less than 1 %
/// from three degrees of freedom on.
double student(double degrees) {
  if (degrees < 1.5) return 12.706204736432095;
  if (degrees < 2.5) return 4.302652729696142;
  const double z3 = z * z * z;
  const double z5 = z3 * z * z;
  const double z7 = z5 * z * z;
  return z + (z3 + z) / (4.0 * degrees) +
         (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * degrees * degrees) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * degrees * degrees * degrees);
}

}  // namespace

std::optional<Estimate> share_of(std::uint64_t hits, std::uint64_t trials) {
  if (trials == 0) return std::nullopt;
  const auto n = static_cast<double>(trials);
  const double p = static_cast<double>(hits) / n;
  const double middle = p + z * z / (2.0 * n);
  const double reach = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  const double scale = 1.0 + z * z / n;
  return Estimate{p, std::clamp((middle - reach) / scale, 0.0, p),
                  std::clamp((middle + reach) / scale, p, 1.0)};
}

std::optional<Estimate> paired_difference(const PairedCounts& counts) {
  const std::uint64_t pairs = counts.pairs();
  const auto a = share_of(counts.both + counts.only_a, pairs);
  const auto b = share_of(counts.both + counts.only_b, pairs);
  if (!a || !b) return std::nullopt;

  const auto n = static_cast<double>(pairs);
  const double ad = static_cast<double>(counts.both) * static_cast<double>(counts.neither);
  const double bc = static_cast<double>(counts.only_a) * static_cast<double>(counts.only_b);
  const double margins = a->value * (1.0 - a->value) * b->value * (1.0 - b->value) * n * n * n * n;
  double correlation = ad > bc ? std::max(ad - bc - 0.5 * n, 0.0) : ad - bc;
  correlation = margins > 0.0 ? correlation / std::sqrt(margins) : 0.0;
  const auto reach = [&](double of_b, double of_a) {
    return std::sqrt(std::max(of_b * of_b - 2.0 * correlation * of_b * of_a + of_a * of_a, 0.0));
  };
  const double difference = b->value - a->value;
  return Estimate{difference, difference - reach(b->value - b->low, a->high - a->value),
                  difference + reach(b->high - b->value, a->value - a->low)};
}

std::optional<Estimate> mean_of(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  if (values.size() == 1) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    return Estimate{mean, -infinite, infinite};
  }
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double reach = student(n - 1.0) * std::sqrt(squares / (n - 1.0) / n);
  return Estimate{mean, mean - reach, mean + reach};
}

}  // namespace stagger::server::campaign
