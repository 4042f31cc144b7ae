// How often one address may command: a bucket of tokens for each.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

namespace stagger::server {

/// A bucket holds `burst` tokens and gains `rate` a second. Pure arithmetic on times passed in.
class RateLimiter {
 public:
  using Clock = std::chrono::steady_clock;

  /// Addresses remembered at a time.
  static constexpr std::size_t max_addresses = 4096;

  /// [1/s] and [1], both more than 0.
  RateLimiter(double rate, double burst) : rate_(rate), burst_(burst) {}

  /// Takes `cost` tokens; else how long the address has to wait for them [s, at least 1].
  std::optional<long> take(const std::string& address, Clock::time_point now, double cost = 1.0);
  std::size_t addresses() const;

 private:
  struct Bucket {
    double tokens = 0.0;
    Clock::time_point at;
  };
  void forget_the_idle(Clock::time_point now);

  const double rate_;
  const double burst_;
  mutable std::mutex mutex_;
  std::unordered_map<std::string, Bucket> buckets_;
};

}  // namespace stagger::server
