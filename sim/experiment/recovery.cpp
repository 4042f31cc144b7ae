#include "sim/experiment/recovery.h"

namespace stagger::sim {

void Recovery::look(const Frame& frame) {
  next_ = frame.tick + 1;
  const bool as_told = (frame.state == WalkingState::idle) == stand_;
  const bool near = (frame.dcm - frame.dcm_reference).norm() <= recovery_tolerance;
  const Vec2 adjustment = frame.adjusted_step.position - frame.planned_step.position;
  if (!as_told || !near || adjustment.norm() > recovery_tolerance) back_ = next_;
}

void Recovery::take(const std::vector<Event>& events) {
  for (const Event& event : events) {
    if (event.kind != EventKind::step) continue;
    ++steps_;
    for (const auto& [name, value] : event.values) {
      if (name == "adjustment" && value > recovery_tolerance) last_recovery_ = steps_;
    }
  }
}

std::optional<std::uint64_t> Recovery::back_tick() const {
  if (back_ > 0 && back_ >= next_) return std::nullopt;
  return back_;
}

}  // namespace stagger::sim
