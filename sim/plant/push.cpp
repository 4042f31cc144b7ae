#include "sim/plant/push.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stagger::sim {
namespace {

constexpr double time_rounding = 1e-9;  // times are sums of ticks [s]

/// Share of the impulse that has been delivered `s` after the start.
double delivered_share(const PushSpec& spec, double s) {
  const double x = std::clamp(s / spec.duration_s, 0.0, 1.0);
  if (spec.profile == PushProfile::rectangular) return x;
  return 0.5 * (1.0 - std::cos(std::numbers::pi * x));
}

bool in_phase(const PhaseTrigger& trigger, const GaitPhase& now) {
  return now.state == trigger.phase && (!trigger.leg || *trigger.leg == now.support_side) &&
         now.fraction >= trigger.fraction - time_rounding;
}

bool is_due(PushRecord& push, double time, const GaitPhase& phase) {
  if (const auto* at = std::get_if<TimeTrigger>(&push.spec.trigger)) {
    return time >= at->at_s - time_rounding;
  }
  if (const auto* trigger = std::get_if<PhaseTrigger>(&push.spec.trigger)) {
    if (in_phase(*trigger, phase)) return push.armed;
    push.armed = true;
    return false;
  }
  return true;
}

}  // namespace

Vec3 horizontal_direction(double degrees) {
  // Exact at the quarters, where cos(pi/2) would leave 6e-17.
  const double quarters = degrees / 90.0;
  if (quarters == std::floor(quarters)) {
    const int quarter = ((static_cast<int>(quarters) % 4) + 4) % 4;
    constexpr double cosines[] = {1.0, 0.0, -1.0, 0.0};
    constexpr double sines[] = {0.0, 1.0, 0.0, -1.0};
    return {cosines[quarter], sines[quarter], 0.0};
  }
  const double angle = degrees * std::numbers::pi / 180.0;
  return {std::cos(angle), std::sin(angle), 0.0};
}

std::uint64_t PushSchedule::add(const PushSpec& spec, std::uint64_t tick) {
  PushRecord record;
  record.id = records_.size() + 1;
  record.spec = spec;
  record.created_tick = tick;
  open_.push_back(records_.size());
  records_.push_back(std::move(record));
  return records_.back().id;
}

bool PushSchedule::cancel(std::uint64_t id, std::uint64_t tick) {
  if (id == 0 || id > records_.size()) return false;
  PushRecord& push = records_[id - 1];
  if (push.state != PushState::scheduled && push.state != PushState::active) return false;
  push.state = PushState::cancelled;
  push.end_tick = tick;
  std::erase(open_, id - 1);
  return true;
}

const std::vector<AppliedForce>& PushSchedule::forces(std::uint64_t tick, double time, double dt,
                                                      const GaitPhase& phase) {
  acting_.clear();
  for (const std::size_t i : open_) {
    PushRecord& push = records_[i];
    if (push.state == PushState::scheduled && is_due(push, time, phase)) {
      push.state = PushState::active;
      push.start_tick = tick;
      const Vec3& d = push.spec.direction;
      const Vec2 planar = engine::rotated(d.head<2>(), phase.heading);
      push.world_direction = {planar.x(), planar.y(), d.z()};
    }
    if (push.state != PushState::active) continue;
    // The mean force over the tick: the impulse is exact whatever the duration.
    const double since = static_cast<double>(tick - *push.start_tick) * dt;
    const double share = delivered_share(push.spec, since + dt) - delivered_share(push.spec, since);
    const Vec3 impulse = push.spec.impulse_ns * share * push.world_direction;
    push.delivered += impulse;
    acting_.push_back({push.spec.link, push.spec.point, impulse / dt});
    if (since + dt >= push.spec.duration_s - time_rounding) {
      push.state = PushState::done;
      push.end_tick = tick;
    }
  }
  std::erase_if(open_, [this](std::size_t i) { return records_[i].state == PushState::done; });
  return acting_;
}

}  // namespace stagger::sim
