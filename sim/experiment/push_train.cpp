#include "sim/experiment/push_train.h"

#include <algorithm>
#include <cmath>

namespace stagger::sim {
namespace {

/// How long a push may wait for its phase or time beyond the settling [s].
constexpr double trigger_patience_s = 10.0;

}  // namespace

PushTrain::PushTrain(std::span<const PushSpec> pushes, bool stand) : recovery_(stand) {
  for (const PushSpec& push : pushes) items_.push_back({push, Recovery(stand), std::nullopt, 0});
}

void PushTrain::schedule(Simulation& simulation) {
  bool before_is_over = true;
  for (Item& item : items_) {
    const auto* at = std::get_if<TimeTrigger>(&item.spec.trigger);
    if (!item.record && (at != nullptr || before_is_over)) {
      const double patience = trigger_patience_s + (at != nullptr ? at->at_s : 0.0);
      item.latest = simulation.next_tick() +
                    static_cast<std::uint64_t>(std::llround(patience / Simulation::tick_s));
      simulation.push(item.spec);
      item.record = simulation.pushes().back();
    }
    before_is_over = item.record && item.record->state == PushState::done;
  }
}

bool PushTrain::overdue(std::uint64_t next_tick) const {
  return std::any_of(items_.begin(), items_.end(), [next_tick](const Item& item) {
    return item.record && !item.record->start_tick && next_tick >= item.latest;
  });
}

void PushTrain::step(Simulation& simulation) {
  // The frame is that of the tick's beginning: a push that starts in it has done nothing yet.
  const std::optional<std::size_t> pushed = newest_;
  const Frame& frame = simulation.step();
  if (pushed || items_.empty()) recovery_.look(frame);
  if (pushed) items_[*pushed].recovery.look(frame);
  look_at_pushes(simulation);
  const std::vector<Event> events = simulation.take_events();
  if (newest_ || items_.empty()) recovery_.take(events);
  if (newest_) items_[*newest_].recovery.take(events);
}

void PushTrain::look_at_pushes(const Simulation& simulation) {
  for (std::size_t i = 0; i < items_.size(); ++i) {
    std::optional<PushRecord>& record = items_[i].record;
    if (!record || record->state == PushState::done) continue;
    const bool waited = !record->start_tick;
    record = simulation.pushes()[record->id - 1];
    if (waited && record->start_tick) newest_ = i;
  }
}

bool PushTrain::done() const {
  return std::all_of(items_.begin(), items_.end(), [](const Item& item) {
    return item.record && item.record->state == PushState::done;
  });
}

std::optional<std::uint64_t> PushTrain::first_tick() const {
  std::optional<std::uint64_t> first;
  for (const Item& item : items_) {
    if (!item.record || !item.record->start_tick) continue;
    first = std::min(first.value_or(*item.record->start_tick), *item.record->start_tick);
  }
  return first;
}

double PushTrain::delivered_ns() const {
  double sum = 0.0;
  for (const Item& item : items_) {
    if (item.record) sum += item.record->delivered.norm();
  }
  return sum;
}

std::vector<PushOutcome> PushTrain::outcomes(bool fell) const {
  std::vector<PushOutcome> result;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const auto& [spec, recovery, record, latest] = items_[i];
    PushOutcome& outcome = result.emplace_back();
    if (!record || !record->start_tick) continue;
    outcome.start_tick = record->start_tick;
    outcome.end_tick = record->end_tick;
    outcome.delivered_ns = record->delivered.norm();
    outcome.fell = fell && newest_ == i;
    if (outcome.fell) continue;
    outcome.steps_to_recover = recovery.steps();
    const auto back = recovery.back_tick();
    if (!back || !record->end_tick) continue;
    const std::uint64_t end = *record->end_tick + 1;
    outcome.recovery_time_s = static_cast<double>(std::max(*back, end) - end) * Simulation::tick_s;
  }
  return result;
}

}  // namespace stagger::sim
