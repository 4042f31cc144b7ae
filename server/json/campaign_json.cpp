#include "server/json/campaign_json.h"

#include "server/json/recording_json.h"

namespace stagger::server {
namespace {

constexpr double ms = 1e-3;  // [s]

}  // namespace

Json campaign_json(const campaign::QueueItem& item) {
  const campaign::Counts& counts = item.counts;
  return {{"id", std::to_string(item.id)},
          {"name", item.name},
          {"state", campaign::name_of(item.state)},
          {"created", iso_8601(ms * static_cast<double>(item.id))},
          {"done", counts.trials},
          {"total", item.most},
          {"total_is_most", item.bisection},
          {"recovered", counts.recovered},
          {"fell", counts.fell},
          {"timeout", counts.timeout},
          {"invalid", counts.invalid},
          {"passed_trials", counts.passed},
          {"eta_s", or_null(item.eta_s)},
          {"passed", or_null(item.passed)},
          {"error", item.error.empty() ? Json() : Json(item.error)}};
}

EventPtr campaign_event(const campaign::QueueItem& item, std::uint64_t tick, double time_s) {
  EventMessage event;
  event.tick = tick;
  event.time = time_s;
  event.kind = "campaign";
  const campaign::Counts& counts = item.counts;
  event.text = "campaign " + item.name + " is " + std::string(campaign::name_of(item.state)) +
               ": " + std::to_string(counts.trials) + " of " + (item.bisection ? "at most " : "") +
               std::to_string(item.most) + " trials, " + std::to_string(counts.fell) + " falls";
  event.values = {{"id", static_cast<double>(item.id)},
                  {"done", static_cast<double>(counts.trials)},
                  {"total", static_cast<double>(item.most)},
                  {"fell", static_cast<double>(counts.fell)}};
  if (item.eta_s) event.values.emplace_back("eta_s", *item.eta_s);
  event.source = "campaign";
  return std::make_shared<const EventMessage>(std::move(event));
}

}  // namespace stagger::server
