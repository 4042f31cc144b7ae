#include "server/http/rate_limiter.h"

#include <algorithm>
#include <cmath>

namespace stagger::server {
namespace {

double seconds_between(RateLimiter::Clock::time_point from, RateLimiter::Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

std::optional<long> RateLimiter::take(const std::string& address, Clock::time_point now,
                                      double cost) {
  const std::lock_guard lock(mutex_);
  if (buckets_.size() >= max_addresses && !buckets_.contains(address)) forget_the_idle(now);
  Bucket& bucket = buckets_.try_emplace(address, Bucket{burst_, now}).first->second;
  const double gained = rate_ * std::max(seconds_between(bucket.at, now), 0.0);
  bucket.tokens = std::min(burst_, bucket.tokens + gained);
  bucket.at = now;
  if (bucket.tokens >= cost) {
    bucket.tokens -= cost;
    return std::nullopt;
  }
  return std::max(1L, std::lround(std::ceil((cost - bucket.tokens) / rate_)));
}

std::size_t RateLimiter::addresses() const {
  const std::lock_guard lock(mutex_);
  return buckets_.size();
}

void RateLimiter::forget_the_idle(Clock::time_point now) {
  // A bucket that is full again is as good as a new one.
  std::erase_if(buckets_, [&](const auto& entry) {
    const Bucket& bucket = entry.second;
    return bucket.tokens + rate_ * seconds_between(bucket.at, now) >= burst_;
  });
  // So many busy addresses are no honest clients: memory is worth more than their buckets.
  if (buckets_.size() >= max_addresses) buckets_.clear();
}

}  // namespace stagger::server
