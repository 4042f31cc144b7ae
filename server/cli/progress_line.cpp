#include "server/cli/progress_line.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

constexpr auto terminal_pause = 200ms;
constexpr auto plain_pause = 10s;
constexpr std::size_t bar_width = 20;

}  // namespace

std::string progress_bar(double share) {
  const double held = std::clamp(share, 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(held * static_cast<double>(bar_width));
  return "[" + std::string(filled, '#') + std::string(bar_width - filled, '.') + "]";
}

std::string minutes_text(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  char text[40];
  std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  return text;
}

std::string progress_text(const sim::LimitsProgress& progress, double elapsed_s) {
  const auto done = static_cast<double>(progress.trials);
  const auto left = static_cast<double>(progress.left);
  char text[200];
  std::snprintf(text, sizeof text, "%s %g m/s, %zu pushes still pass, %zu trials, at most %s left",
                progress_bar(done / std::max(done + left, 1.0)).c_str(), progress.rung,
                progress.open_cells, progress.trials,
                minutes_text(elapsed_s / std::max(done, 1.0) * left).c_str());
  return text;
}

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressLine::show(const std::function<std::string(double)>& text_after) {
  const auto now = Clock::now();
  if (quiet_ || now < next_) return;
  next_ = now + (terminal_ ? Clock::duration(terminal_pause) : Clock::duration(plain_pause));
  const std::chrono::duration<double> elapsed = now - start_;
  const std::string text = text_after(elapsed.count());
  // The escape sequence clears the rest of the line.
  std::cerr << (terminal_ ? "\r" + text + "\x1b[K" : text + '\n') << std::flush;
  shown_ = true;
}

void ProgressLine::clear() {
  if (terminal_ && shown_) std::cerr << "\r\x1b[K" << std::flush;
  shown_ = false;
}

}  // namespace stagger::server
