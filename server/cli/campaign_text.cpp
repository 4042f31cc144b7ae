#include <iomanip>
#include <sstream>

#include "server/cli/campaign.h"

namespace stagger::server {
namespace {

using campaign::Estimate;

/// Three digits that mean something.
std::string short_number(double value) {
  std::ostringstream text;
  text << std::setprecision(4) << value;
  return text.str();
}

std::string short_number(const std::optional<double>& value) {
  return value ? short_number(*value) : "-";
}

std::string estimate_text(const std::optional<Estimate>& estimate, double scale = 1.0) {
  if (!estimate) return "not known";
  return short_number(estimate->value * scale) + " (95 %: " + short_number(estimate->low * scale) +
         " to " + short_number(estimate->high * scale) + ")";
}

/// {"push.direction_deg":15} as "push.direction_deg 15".
std::string values_text(const Json& values) {
  std::string text;
  for (const auto& [path, value] : values.items()) {
    text += (text.empty() ? "" : ", ") + path + " " + to_text(value);
  }
  return text;
}

void add_limits(std::ostream& out, const campaign::Plan& plan, const campaign::Summary& summary) {
  out << "limits of " << plan.spec().design.bisection.axis
      << ": [highest all-pass below, lowest any-fail]\n";
  std::size_t not_begun = 0;
  for (const campaign::CellLimit& limit : summary.limits) {
    if (limit.limit.trials == 0) {
      ++not_begun;
      continue;
    }
    out << "  " << values_text(limit.values) << ": [" << short_number(limit.pass) << ", "
        << short_number(limit.fail) << "]";
    if (limit.at_pass) {
      out << "  " << short_number(limit.at_pass->impulse_ns) << " N s, "
          << short_number(limit.at_pass->force_n) << " N, delta-v "
          << short_number(limit.at_pass->delta_v) << " m/s, Fr " << short_number(limit.at_pass->fr);
      if (limit.ceiling_dv && *limit.ceiling_dv > 0.0) {
        out << ", " << short_number(100.0 * limit.at_pass->delta_v / *limit.ceiling_dv)
            << " % of the ceiling";
      }
    }
    if (!limit.limit.monotone) {
      out << "  NOT MONOTONE: passes at " << short_number(limit.highest_pass) << " again";
    }
    if (limit.limit.undecided) out << "  UNDECIDED: a push never came";
    if (!limit.limit.done) out << "  (not finished)";
    out << '\n';
  }
  if (not_begun > 0) out << "  " << not_begun << " more have not begun\n";
}

}  // namespace

std::string summary_text(const campaign::Plan& plan, const campaign::Summary& summary) {
  std::ostringstream out;
  const campaign::Counts& counts = summary.counts;
  const char* state = "not finished";
  if (summary.state == campaign::State::complete) state = "complete";
  if (summary.state == campaign::State::invalid) state = "INVALID";
  out << plan.spec().name << ": " << state << ", " << counts.trials
      << " trials: " << counts.recovered << " recovered, " << counts.fell << " fell, "
      << counts.timeout << " timed out, " << counts.invalid << " invalid; fall rate "
      << estimate_text(campaign::fall_rate(counts)) << '\n';
  if (!summary.limits.empty()) add_limits(out, plan, summary);
  for (const campaign::ThresholdResult& result : summary.thresholds) {
    out << (result.passed ? "  passed: " : "  FAILED: ") << result.text << " (it is "
        << (result.value ? short_number(*result.value) : "not known") << ")\n";
  }
  out << counts.twice << " trials run twice, " << summary.mismatches.size()
      << " of them with two results; results " << summary.results_hash << '\n';
  if (summary.cpu_s > 0.0) {
    out << short_number(static_cast<double>(counts.trials) / summary.cpu_s)
        << " trials a second of one core, " << short_number(summary.simulated_s / summary.cpu_s)
        << " x real time\n";
  }
  return out.str();
}

std::string comparison_text(const campaign::CampaignComparison& comparison) {
  constexpr double percent = 100.0;
  std::ostringstream out;
  out << comparison.pairs << " pairs of trials, " << comparison.only_a << " of A and "
      << comparison.only_b << " of B without a partner\n"
      << "share that does not pass, B less A, in percent:\n";
  for (const campaign::PairedGroup& group : comparison.groups) {
    if (group.failures.pairs() == 0) continue;
    out << "  " << (group.path.empty() ? "all" : group.path + " " + to_text(group.value)) << ": "
        << estimate_text(group.difference, percent) << "; newly failing " << group.failures.only_b
        << ", no longer " << group.failures.only_a << " of " << group.failures.pairs() << '\n';
  }
  for (const campaign::PairedMeasure& measure : comparison.measures) {
    out << measure.name << ", B less A, of " << measure.pairs
        << " pairs that pass: " << estimate_text(measure.difference) << '\n';
  }
  for (const campaign::PairedLimit& limit : comparison.limits) {
    out << "  limit, " << values_text(limit.values) << ": " << short_number(limit.a) << " -> "
        << short_number(limit.b) << '\n';
  }
  if (!comparison.limits.empty()) {
    out << "change of the limits in percent: " << estimate_text(comparison.limit_change, percent)
        << '\n';
  }
  if (!comparison.worse.empty()) {
    out << "trials of B that fail and did not:";
    constexpr std::size_t most = 20;
    for (std::size_t i = 0; i < std::min(comparison.worse.size(), most); ++i) {
      out << ' ' << comparison.worse[i];
    }
    out << (comparison.worse.size() > most ? " ...\n" : "\n");
  }
  for (const std::string& regression : comparison.regressions) {
    out << "WORSE: " << regression << '\n';
  }
  if (comparison.regressions.empty()) out << "not worse\n";
  return out.str();
}

}  // namespace stagger::server
