// How far a long search is, on standard error.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "sim/experiment/limits.h"

namespace stagger::server {

/// On a terminal one line that is written again and again; else a plain line now and then.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Writes the text when it is time to; it is told the time since the beginning [s].
  void show(const std::function<std::string(double)>& text);
  /// Takes the line off the terminal.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_;
};

/// "[####......]"; `share` from 0 to 1.
std::string progress_bar(double share);

/// "1:05".
std::string minutes_text(double seconds);

/// "[####......] 0.35 m/s, 12 pushes still pass, 240 trials, at most 1:05 left".
std::string progress_text(const sim::LimitsProgress& progress, double elapsed_s);

}  // namespace stagger::server
