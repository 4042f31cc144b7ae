// Keeps ticks at the pace of the wall clock, and measures how well that goes.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

namespace stagger::server {

/// Pure arithmetic on times that are passed in; whoever uses it does the sleeping.
class Pacer {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// A tick that starts later than this counts as late.
  static constexpr Duration late = std::chrono::milliseconds(5);
  /// Time that is lost beyond this is given up: after a stall of a second, a burst of a thousand
  /// ticks would be one more stall for everyone who waits for an answer.
  static constexpr Duration max_backlog = std::chrono::milliseconds(50);

  explicit Pacer(Duration tick) : tick_(tick), period_(tick) {}

  /// Simulated seconds in a second of wall time, more than 0; nothing: as fast as it goes.
  void set_speed(std::optional<double> factor, Time now) {
    speed_ = factor;
    period_ = factor ? std::chrono::duration_cast<Duration>(tick_ / *factor) : Duration::zero();
    restart(now);
  }
  std::optional<double> speed() const { return speed_; }

  /// The next tick is due now (start, resume).
  void restart(Time now) {
    due_ = now;
    window_start_ = now;
    window_ticks_ = 0;
  }

  /// When the next tick is due.
  Time due() const { return due_; }

  /// A tick starts now.
  void tick(Time now) {
    // As fast as it goes, a tick is never late.
    const Duration lateness = speed_ ? std::max(now - due_, Duration::zero()) : Duration::zero();
    if (lateness > late) ++late_ticks_;
    worst_lateness_ = std::max(worst_lateness_, lateness);
    due_ = !speed_ || lateness > max_backlog ? now + period_ : due_ + period_;
    ++window_ticks_;
    if (now - window_start_ >= std::chrono::seconds(1)) {
      using Seconds = std::chrono::duration<double>;
      real_time_factor_ =
          window_ticks_ * Seconds(tick_).count() / Seconds(now - window_start_).count();
      window_start_ = now;
      window_ticks_ = 0;
    }
  }

  std::uint64_t late_ticks() const { return late_ticks_; }
  double worst_lateness_ms() const {
    return std::chrono::duration<double, std::milli>(worst_lateness_).count();
  }
  /// Simulated seconds in a second of wall time, over the last full second.
  double real_time_factor() const { return real_time_factor_; }

 private:
  Duration tick_;    ///< of simulation time
  Duration period_;  ///< of wall time from one tick to the next
  std::optional<double> speed_ = 1.0;
  Time due_;
  Time window_start_;
  double window_ticks_ = 0.0;
  std::uint64_t late_ticks_ = 0;
  Duration worst_lateness_ = Duration::zero();
  double real_time_factor_ = 1.0;
};

}  // namespace stagger::server
