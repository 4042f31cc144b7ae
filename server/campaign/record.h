// What is kept of a trial that has been run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "server/campaign/design.h"
#include "server/campaign/plan.h"
#include "sim/experiment/trial.h"

namespace stagger::server::campaign {

struct Record {
  std::uint64_t number = 0;
  std::string id;
  std::uint64_t seed = 0;
  std::uint64_t repeat = 0;
  std::string values;  ///< what the campaign set, as JSON
  PushFigures push;
  std::optional<double> ceiling_dv;  ///< of sim::trial_ceiling() [m/s]
  sim::TrialResult result;
  bool passed = false;
  std::optional<bool> repeated;  ///< of a trial that was run twice: the same to the bit?
  double cpu_s = 0.0;            ///< of one core, for one run; no part of the result [s]
};

Verdict verdict_of(const Record& record);

/// Did two runs of one trial give the same, to the bit?
bool same_result(const sim::TrialResult& a, const sim::TrialResult& b);

/// A number for the result of this trial, whenever and wherever it was run.
std::uint64_t hash_of(const Record& record);

}  // namespace stagger::server::campaign
