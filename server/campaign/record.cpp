#include "server/campaign/record.h"

#include "server/campaign/hash.h"
#include "sim/state_hash.h"

namespace stagger::server::campaign {
namespace {

template <typename T>
void mix(sim::StateHash& hash, const std::optional<T>& value) {
  hash.mix(std::uint64_t{value.has_value()});
  if (value) hash.mix(*value);
}

}  // namespace

Verdict verdict_of(const Record& record) {
  switch (record.result.outcome) {
    case sim::TrialOutcome::timeout:
    case sim::TrialOutcome::invalid:
      return Verdict::undecided;
    case sim::TrialOutcome::recovered:
    case sim::TrialOutcome::fell:
      break;
  }
  return record.passed ? Verdict::pass : Verdict::fail;
}

bool same_result(const sim::TrialResult& a, const sim::TrialResult& b) {
  Record first;
  Record second;
  first.result = a;
  second.result = b;
  return hash_of(first) == hash_of(second);
}

std::uint64_t hash_of(const Record& record) {
  const sim::TrialResult& r = record.result;
  sim::StateHash hash;
  hash.mix(record.number);
  hash.mix(hash_text(record.id));
  hash.mix(record.seed);
  hash.mix(hash_text(record.values));
  hash.mix(static_cast<std::uint64_t>(r.outcome));
  hash.mix(hash_text(r.reason));
  hash.mix(r.delivered_ns);
  mix(hash, r.push_tick);
  mix(hash, r.steps_to_recover);
  mix(hash, r.recovery_time_s);
  mix(hash, r.fall_time_s);
  hash.mix(r.worst_dcm_error_m);
  hash.mix(r.ticks);
  hash.mix(r.state_hash);
  return hash.value();
}

}  // namespace stagger::server::campaign
